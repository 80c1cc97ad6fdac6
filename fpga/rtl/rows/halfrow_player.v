// Plays rows into the core as a sensor would: decides at every clock whether a sample enters, a pixel clock passes
// without one, or none passes. What it decides stands at the core's pins one clock later. In a burst none ever passes
// without the enable.
`default_nettype none

module halfrow_player #(
    parameter TAPS = 7,
    parameter COLUMN_BITS = 11
) (
    input  wire                   clk,
    input  wire                   rst,         // also while rows are dropped

    input  wire [11:0]            width,
    input  wire [15:0]            blanking,    // pixel clocks
    input  wire [31:0]            seed,        // of gaps, or the first draw of a burst's row that starts next
    input  wire                   burst,       // rows are a burst's
    input  wire [15:0]            frame_blanking, // pixel clocks between two of its frames

    input  wire                   row_ready,   // the next row may start
    input  wire                   row_0,       // it begins a frame
    input  wire                   row_is_last, // it ends one
    output wire                   start,       // pulse: it does start
    output wire                   sample_read, // the sample of `column` is to be at the pins
    output wire [COLUMN_BITS-1:0] column,
    output wire                   draws_first, // pulse: the generator is set to the seed
    output wire [31:0]            draw,        // of a burst's sample

    output wire                   enables,     // `enable` of the next clock
    output reg                    enable,
    output reg                    in_valid,
    output reg                    in_start,
    output reg                    in_last,
    output reg  [15:0]            pauses,      // board clocks that gaps held the row up, complete with in_last

    output reg                    under_way,   // a row has started and its last sample has not entered
    output wire                   flushing,    // behind a frame
    output reg                    ends_frame,  // the row under way, or played last, ends one
    output wire                   due          // the blanking has passed, and the next row may start
);
    `include "halfrow_board.vh"

    localparam L = latency_of(TAPS);
    localparam NO_DRAW = 2'd0, BLANKING_DRAWN = 2'd1, ALL_DRAWN = 2'd2;

    reg in_row;
    reg [COLUMN_BITS-1:0] next_column, last_but_one;
    reg at_last; // next_column is the row's last
    reg paused;
    reg [1:0] draws;  // in front of the next row
    reg [15:0] blank; // pixel clocks that must pass before it
    reg [3:0] extra;  // further ones, from the generator
    reg [11:0] flush; // pixel clocks that bring a frame's rest out

    wire gaps_on;
    wire [3:0] drawn;

    // The last sample of a row needs no further draw, so the draws for the next row begin with it.
    wire draws_done = draws == ALL_DRAWN || (draws == BLANKING_DRAWN && !gaps_on);
    wire none_blank = blank == 16'd0;
    wire may_start = !in_row && row_ready && draws_done && none_blank && extra == 4'd0;
    wire pause = gaps_on && drawn[2:0] == 3'd0 && !paused;
    wire sample_enters = (in_row || may_start) && !pause;
    wire last_enters = in_row && !pause && at_last;
    wire waits = row_ready && draws_done;
    wire draining = ends_frame && (flush != 12'd0 || !none_blank);
    wire blank_passes = !in_row && !may_start && (burst || (row_ready ? waits : draining));

    wire draw_first = row_ready && draws == NO_DRAW && (!in_row || (at_last && !pause));
    wire draw_second = row_ready && draws == BLANKING_DRAWN && !in_row;
    wire draw_sample = (in_row ? !at_last : may_start) && !pause;

    assign enables = (sample_enters || blank_passes) && !rst;
    assign start = may_start && !pause;
    assign sample_read = sample_enters;
    assign column = in_row ? next_column : {COLUMN_BITS{1'b0}};
    assign draws_first = draw_first && (row_0 || burst);
    assign due = !in_row && none_blank;
    assign flushing = !in_row && ends_frame && flush != 12'd0;

    halfrow_gaps gaps (
        .clk(clk), .rst(rst), .burst(burst), .seed(seed), .restart(draws_first),
        .draw(burst ? sample_enters : draw_first || draw_second || draw_sample), .drawn(drawn), .next(draw),
        .on(gaps_on));

    always @(posedge clk)
        if (rst)
            draws <= NO_DRAW;
        else if (start)
            draws <= NO_DRAW;
        else if (draw_first)
            draws <= BLANKING_DRAWN;
        else if (draw_second)
            draws <= ALL_DRAWN;

    always @(posedge clk)
        if (rst) begin
            in_row <= 1'b0;
            ends_frame <= 1'b0;
            blank <= 16'd0;
            extra <= 4'd0;
            flush <= 12'd0;
            paused <= 1'b0;
        end else begin
            in_row <= start || (in_row && !last_enters);
            paused <= (in_row || may_start) && pause;
            if (start)
                ends_frame <= row_is_last;
            if (last_enters) begin
                blank <= burst && ends_frame ? frame_blanking : blanking;
                flush <= {1'b0, width[11:1]} + L[11:0];
            end else if (blank_passes) begin
                if (!none_blank)
                    blank <= blank - 16'd1;
                if (flush != 12'd0)
                    flush <= flush - 12'd1;
            end
            if (draw_second)
                extra <= row_0 || !gaps_on ? 4'd0 : drawn;
            else if (blank_passes && none_blank && extra != 4'd0)
                extra <= extra - 4'd1;
        end

    always @(posedge clk)
        enable <= enables;

    always @(posedge clk) begin
        last_but_one <= width[COLUMN_BITS-1:0] - {{COLUMN_BITS-2{1'b0}}, 2'd2};
        next_column <= sample_enters ? column + 1'b1 : column;
        at_last <= in_row && (sample_enters ? next_column == last_but_one : at_last);
    end

    always @(posedge clk)
        if (rst) begin
            in_valid <= 1'b0;
            in_start <= 1'b0;
            in_last <= 1'b0;
            under_way <= 1'b0;
        end else begin
            in_valid <= sample_enters;
            in_start <= start;
            in_last <= last_enters;
            under_way <= start || (under_way && !in_last);
        end

    always @(posedge clk)
        if (rst || in_last)
            pauses <= 16'd0;
        else if ((in_row || may_start) && pause && pauses != 16'hffff)
            pauses <= pauses + 16'd1;

    wire unused = &{1'b0, width[0]}; // W is even
endmodule

`default_nettype wire
