// The samples of a burst's rows, AT-SPEED.md's Content. The player's generator makes the draws; the first one of a row
// is made here, so that rows may follow each other without a clock between them.
`default_nettype none

module halfrow_content (
    input  wire                   clk,
    input  wire                   burst,
    input  wire [1:0]             depth,      // 0: 8 bits, 1: 10, 2: 12

    input  wire [31:0]            seed,
    input  wire [15:0]            frame,      // number of the frame of the row that starts next
    input  wire [11:0]            row,        // in it
    input  wire [31:0]            gap_seed,
    output wire [31:0]            first,      // what the generator is set to: a burst's row begins with its first draw
    input  wire                   begins_row, // pulse: it is

    input  wire                   enters,     // the sample of `column` does a clock later
    input  wire                   row_starts, // and is the row's first
    input  wire [3:0]             column,     // its low bits
    input  wire [31:0]            draw,       // that column's
    output reg  [11:0]            sample
);
    `include "halfrow_board.vh"

    localparam [1:0] NOISE = 2'd0, SWING = 2'd1, TOGGLE = 2'd2, STEPS = 2'd3;

    wire [31:0] numbered = seed ^ {4'd0, frame, row};
    wire [31:0] first_draw;

    halfrow_xorshift xorshift (.x({1'b1, numbered[30:0]}), .next(first_draw));

    assign first = burst ? first_draw : gap_seed;

    reg [1:0] kind;
    reg [1:0] period;
    reg phase;

    always @(posedge clk)
        if (begins_row)
            {phase, period, kind} <= first_draw[4:0];

    wire is_high = kind == SWING ? draw[31] : column[period] ^ phase;
    wire has_levels = kind == NOISE || kind == STEPS;
    wire [11:0] value = has_levels ? draw[31:20] : {12{is_high}};
    wire [11:0] used = {{2{depth == DEPTH_12}}, {2{depth != DEPTH_8}}, 8'hff};
    wire stays = kind == STEPS && draw[3:0] != 4'd0 && !row_starts;

    always @(posedge clk)
        if (enters && !stays)
            sample <= value & used;

    wire unused = &{1'b0, numbered[31], draw[19:4], TOGGLE};
endmodule

`default_nettype wire
