// A row on its way out: the source coordinate of each column by exact accumulation, S[j+1] = S[j] + 2Q or that of
// halfrow_parabolas, and from it the kernel position, the samples to read, and which of the two colours is the output's
// own.
`default_nettype none

module halfrow_source #(
    parameter RING_BITS = 11,
    parameter GRID = 0
) (
    input  wire                 clk,
    input  wire                 rst,
    input  wire                 enable,
    input  wire [11:0]          width,

    input  wire                 row_begin,
    input  wire [36:0]          position,      // S[0] + 2^11; of a grid S[0] / 8 + 2^11
    input  wire [24:0]          step,          // Q, or Q[0]
    input  wire                 bank,

    input  wire                 has_grid,      // of the row that begins
    input  wire                 long_segments,
    input  wire signed [23:0]   first_slope,
    input  wire signed [23:0]   next_slope,    // of the row that leaves
    input  wire signed [23:0]   hand_over,
    output wire                 ask_next,

    input  wire [RING_BITS-1:0] first_address, // of the sample in front of the first to be read
    input  wire                 row_end,       // the row that enters has got all of its samples
    input  wire [RING_BITS-1:0] last_address,  // of that column
    output reg  [RING_BITS-1:0] read_address,

    output wire [5:0]           node,
    output wire [7:0]           fraction,
    output reg                  leaving_bank,

    // Three enabled clocks behind `node`:
    output wire                 load,          // take the opening window
    output wire                 move,          // take one more sample
    // and four behind it, one in front of its weights:
    output wire                 other_colour,  // column n is not of the output's colour
    output wire                 made_valid,
    output wire                 made_start,
    output wire                 made_last
);
    wire [36:0] s;
    reg [11:0] begun; // columns, with the present one
    reg reading, starting;
    wire last = begun == width;
    wire n_is_odd = s[25];
    wire not_own = n_is_odd ^ !begun[0];
    wire unused_bits = &{1'b0, s[36:26], s[11:0]};

    generate
        if (GRID != 0) begin : grid
            halfrow_parabolas parabolas (
                .clk(clk), .enable(enable), .row_begin(row_begin), .position(position), .factor(step),
                .has_grid(has_grid), .long_segments(long_segments), .first_slope(first_slope), .next_slope(next_slope),
                .hand_over(hand_over), .reading(reading), .begun(begun[5:0]), .ask_next(ask_next), .s(s));
        end else begin : line
            reg [36:0] sum;
            reg [24:0] row_step;

            always @(posedge clk)
                if (enable)
                    sum <= row_begin ? position : sum + {11'd0, row_step, 1'b0};

            always @(posedge clk)
                if (row_begin)
                    row_step <= step;

            assign s = sum;
            assign ask_next = 1'b0;
            wire unused = &{1'b0, has_grid, long_segments, first_slope, next_slope, hand_over};
        end
    endgenerate

    always @(posedge clk)
        if (row_begin)
            leaving_bank <= bank;

    always @(posedge clk)
        if (enable)
            begun <= row_begin ? 12'd1 : begun + 12'd1;

    always @(posedge clk)
        if (rst)
            reading <= 1'b0;
        else if (enable)
            reading <= row_begin || (reading && !last);

    always @(posedge clk)
        if (enable)
            starting <= row_begin;

    assign node = {not_own, s[24:20]};
    assign fraction = s[19:12];

    // n never moves by more than one, so its parity tells whether it has.
    reg n_was_odd;
    reg [2:0] loads, moves;
    reg [3:0] not_owns, starts, lasts, valids;

    always @(posedge clk)
        if (enable) begin
            n_was_odd <= n_is_odd;
            loads <= {loads[1:0], reading && starting};
            moves <= {moves[1:0], reading && !starting && (n_is_odd ^ n_was_odd)};
            not_owns <= {not_owns[2:0], not_own};
            starts <= {starts[2:0], starting};
            lasts <= {lasts[2:0], last};
        end

    always @(posedge clk)
        if (rst)
            valids <= 4'd0;
        else if (enable)
            valids <= {valids[2:0], reading};

    assign load = loads[2];
    assign move = moves[2];
    assign other_colour = not_owns[3];
    assign made_valid = valids[3];
    assign made_start = starts[3];
    assign made_last = lasts[3];

    // Right of column W - 1 the columns W - 2 and W - 1 take turns, so behind the last one the address goes back by
    // one.
    reg ended;
    wire back = !loads[1] && ended && read_address == last_address;
    wire [RING_BITS-1:0] from = loads[1] ? first_address : read_address;

    always @(posedge clk)
        if (enable && loads[1])
            ended <= 1'b0;
        else if (row_end)
            ended <= 1'b1;

    always @(posedge clk)
        if (enable && (loads[1] || moves[1]))
            read_address <= {{RING_BITS-1{back}}, 1'b1} + from;
endmodule

`default_nettype wire
