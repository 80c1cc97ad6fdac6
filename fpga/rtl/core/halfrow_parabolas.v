// The source coordinate along a row with a grid: S[j + 1] = S[j] + D, and D grows by 2G in a segment and by
// G[s] + G[s + 1] from a segment's last column to the next one's first, which makes it 16Q + G there.
`default_nettype none

module halfrow_parabolas (
    input  wire               clk,
    input  wire               enable,
    input  wire               row_begin,
    input  wire [36:0]        position,      // S[0] / 8 + 2^11
    input  wire [24:0]        factor,        // Q[0]
    input  wire               has_grid,
    input  wire               long_segments, // of 64 columns, not of 32
    input  wire signed [23:0] first_slope,   // G[0]
    input  wire signed [23:0] next_slope,    // G[s + 1]
    input  wire signed [23:0] hand_over,     // G[s] + G[s + 1]
    input  wire               reading,       // the row is leaving
    input  wire [5:0]         begun,         // columns, with the present one
    output wire               ask_next,      // pulse: next_slope and hand_over are taken
    output wire [36:0]        s              // (S + 2^14) / 8
);
    reg [39:0] sum;           // S + 2^14
    reg [28:0] step;          // D
    reg signed [24:0] growth; // of D with the next column
    reg signed [23:0] slope;  // G of the segment that comes next, until it has come
    reg handing_over, leaving_grid, leaving_long;
    wire last_but_one = &begun[4:0] && (begun[5] || !leaving_long);

    assign ask_next = enable && reading && !row_begin && leaving_grid && last_but_one;
    assign s = sum[39:3];
    wire unused = &{1'b0, sum[2:0]};

    wire signed [24:0] increase = row_begin ? {first_slope[23], first_slope} : growth;

    always @(posedge clk)
        if (enable) begin
            sum <= row_begin ? {position, 3'd0} : sum + {11'd0, step};
            step <= (row_begin ? {factor, 4'd0} : step) + {{4{increase[24]}}, increase};
            handing_over <= ask_next;
        end

    always @(posedge clk) begin
        if (row_begin)
            {leaving_grid, leaving_long} <= {has_grid, long_segments};
        if (ask_next)
            slope <= next_slope;
        if (row_begin)
            growth <= {first_slope, 1'b0};
        else if (ask_next)
            growth <= {hand_over[23], hand_over};
        else if (enable && handing_over)
            growth <= {slope, 1'b0};
    end
endmodule

`default_nettype wire
