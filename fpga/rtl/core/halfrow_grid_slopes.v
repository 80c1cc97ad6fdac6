// From the factors at the nodes of a row, one after the other, what its parabolas are made of: G[s] of
// fpga/DATAPATH.md, and G[s] + G[s + 1], by which D grows at the hand-over from a segment to the next. Both are
// differences of factors.
`default_nettype none

module halfrow_grid_slopes (
    input  wire               clk,
    input  wire               rst,

    input  wire [24:0]        value,         // of the spline
    input  wire               node_0,        // pulses: it is a factor of the row that is prepared,
    input  wire               node_1,
    input  wire               node_next,     // or the one that the row that leaves needs next
    input  wire               plain,         // pulse: `entry` is the only one of a row without a grid
    input  wire [24:0]        entry,
    input  wire               long_segments, // k of the row that is prepared is 6
    input  wire               cancel,        // pulse: it is not wanted any more
    input  wire               leave,         // pulse: it leaves

    output reg  [24:0]        factor,        // Q[0] of the one prepared, a clock behind plain, two behind node_0
    output reg  signed [23:0] first_slope,   // G[0], a clock behind plain, two behind node_1
    output reg                sloped,        // pulse: it is there
    output reg  signed [23:0] next_slope,    // of the row that leaves: G[s + 1], three clocks behind node_next
    output reg  signed [23:0] hand_over      // and G[s] + G[s + 1]
);
    reg [24:0] found;
    reg is_0, is_1, is_next, is_twice; // `found` is that; is_twice: for the second clock
    reg [21:0] last_prepared, last_leaving, before_leaving; // nodes 1, s + 1 and s, in units of 8
    reg long_leaving;

    wire unused = &{1'b0, value[2:0]};

    always @(posedge clk) begin
        if (value[24]) // Q is no greater than 2^24
            found <= {1'b1, 24'd0};
        else
            found <= {1'b0, value[23:3], 3'd0};
        if (plain || is_0)
            factor <= plain ? entry : found;
        if (is_1)
            last_prepared <= found[24:3];
    end

    always @(posedge clk)
        if (rst) begin
            is_0 <= 1'b0;
            is_1 <= 1'b0;
            is_next <= 1'b0;
            is_twice <= 1'b0;
            sloped <= 1'b0;
        end else begin
            is_0 <= node_0;
            is_1 <= node_1 && !cancel;
            is_next <= node_next && !leave;
            is_twice <= is_next && !leave;
            sloped <= (plain || is_1) && !cancel;
        end

    always @(posedge clk)
        if (leave) begin
            {last_leaving, before_leaving} <= {last_prepared, factor[24:3]};
            long_leaving <= long_segments;
        end else if (is_twice)
            {last_leaving, before_leaving} <= {found[24:3], last_leaving};

    wire [21:0] from = is_1 ? factor[24:3] : is_twice ? before_leaving : last_leaving;
    wire signed [22:0] difference = {1'b0, found[24:3]} - {1'b0, from};
    wire is_long = is_1 ? long_segments : long_leaving;
    wire signed [23:0] slope = is_long ? {difference[22], difference} : {difference, 1'b0};

    always @(posedge clk) begin
        if (plain)
            first_slope <= 24'd0;
        else if (is_1)
            first_slope <= slope;
        if (is_next)
            next_slope <= slope;
        if (is_twice)
            hand_over <= slope;
    end
endmodule

`default_nettype wire
