// halfrow_player under rows that come whenever they like, beside WIRE.md's section "The player": what a host cannot see of it. The
// monitor knows the page alone, its generator of gaps too; it sees the core's pins and when a row was there. With BURST it
// is AT-SPEED.md's Time: the rows of a frame are there in time, and no clock passes without the enable.
`default_nettype none

module player #(
    parameter W = 4,                         // columns
    parameter MOST_BLANKING = 2,
    parameter GAPS = 1,                      // 0: the seed 0
    parameter BURST = 0                      // 1: rows are a burst's
) (
    input wire clk,
    input wire wants_reset,
    input wire wants_row,
    input wire begins_frame,
    input wire ends_frame
);
    localparam TAPS = 5, L = 11;
    localparam REST = W / 2 + L;             // pixel clocks that bring a frame's rest out
    localparam SOON = 3;                     // clocks that two draws and a pause may take

    (* anyconst *) wire [15:0] blanking;
    (* anyconst *) wire [15:0] frame_blanking;
    (* anyconst *) wire [3:0] seed_bits;
    (* anyseq *) wire [31:0] first_draw;     // of a burst's row
    wire [31:0] seed = BURST ? first_draw : GAPS ? {seed_bits[3:1], 28'h5a17c3a, 1'b1} : 32'd0;

    reg running = 1'b0;
    always @(posedge clk) running <= 1'b1;
    wire rst = !running || wants_reset;

    // The row that is prepared. What follows a frame's last row is a row 0, as is the first of all.
    reg row_ready, row_0, row_is_last, needs_row_0;
    wire start, enables, enable, in_valid, in_start, in_last, under_way, flushing, sample_read;
    wire [2:0] column;
    wire [15:0] pauses;

    always @(posedge clk)
        if (rst) begin
            row_ready <= 1'b0;
            needs_row_0 <= 1'b1;
        end else if (row_ready ? start : wants_row || (BURST && !needs_row_0)) begin
            row_ready <= !row_ready;
            if (row_ready)
                needs_row_0 <= row_is_last;
            else begin
                row_0 <= (begins_frame && !BURST) || needs_row_0;
                row_is_last <= ends_frame;
            end
        end

    halfrow_player #(.TAPS(TAPS), .COLUMN_BITS(3)) dut (
        .clk(clk), .rst(rst), .width(W[11:0]), .blanking(blanking), .burst(BURST != 0),
        .frame_blanking(frame_blanking), .seed(seed),
        .row_ready(row_ready), .row_0(row_0), .row_is_last(row_is_last), .start(start), .sample_read(sample_read),
        .column(column), .enables(enables), .enable(enable), .in_valid(in_valid), .in_start(in_start), .in_last(in_last),
        .pauses(pauses), .under_way(under_way), .flushing(flushing));

    function [31:0] drawn(input [31:0] x);
        reg [31:0] y;
        begin
            y = x ^ x << 13;
            y = y ^ y >> 17;
            drawn = y ^ y << 5;
        end
    endfunction

    // What stood at the pins.
    reg         first = 1'b1;                // no row has entered yet
    reg         inside = 1'b0;               // a row has entered in part
    reg         frame_over = 1'b0;           // the newest row is its frame's last
    reg         entering_0, entering_last;   // of the row that starts with this clock
    reg  [2:0]  taken = 3'd0;                // its samples
    reg  [7:0]  blank = 8'd0;                // pixel clocks since the last one
    reg  [2:0]  waited = 3'd0;               // clocks for which a row 0 was there and all blanking had passed
    reg  [2:0]  held = 3'd0;                 // clocks without enable: between two samples, or while a row is there
    reg  [31:0] x;                           // the newest draw
    reg  [15:0] paused = 16'd0;              // draws of this row that ask for a pause

    wire [31:0] in_front = drawn(x);         // rule 1: the draw before a row
    wire [31:0] of_first = entering_0 ? drawn(seed) : drawn(in_front);
    wire [31:0] of_sample = in_start ? of_first : drawn(x);
    wire        asks = GAPS && of_sample[2:0] == 3'd0;
    wire [15:0] paused_now = (in_start ? 16'd0 : paused) + asks;
    wire [7:0]  due = blanking[7:0] + (GAPS && !entering_0 ? {4'd0, in_front[3:0]} : 8'd0);
    wire        ready_idle = row_ready && !inside && !in_valid;
    wire [15:0] before_0 = BURST ? frame_blanking : blanking;

    always @(posedge clk) begin
        assume (blanking <= MOST_BLANKING && frame_blanking <= MOST_BLANKING + 2);
        if (start)
            {entering_0, entering_last} <= {row_0, row_is_last};
        if (rst) begin
            first <= 1'b1;
            inside <= 1'b0;
            frame_over <= 1'b0;
            blank <= 8'd0;
            held <= 3'd0;
            waited <= 3'd0;
        end else begin
            waited <= ready_idle && row_0 && (first || blank >= before_0) ? waited + (waited != 3'd7) : 3'd0;
            held <= enable || !(inside || ready_idle) ? 3'd0 : held + (held != 3'd7);
            if (in_valid) begin
                x <= of_sample;
                paused <= paused_now;
                taken <= in_start ? 3'd1 : taken + 3'd1;
                inside <= !in_last;
                first <= 1'b0;
                blank <= 8'd0;
                frame_over <= in_last && entering_last;
            end else if (enable)
                blank <= blank + 8'd1;
        end
    end

    reg was_ready = 1'b0;                    // a row was there when this clock was decided on
    reg was_running = 1'b0;
    always @(posedge clk) begin
        was_ready <= row_ready && !rst;
        was_running <= !rst;
    end

    always @(posedge clk)
        if (running && !rst) begin
            samples_on_pixel_clocks: assert (enable || !in_valid);
            starts_between_rows: assert (!in_valid || in_start == !inside);
            every_pixel_clock_a_sample: assert (!inside || in_valid || !enable);
            whole_rows: assert (!in_valid || in_last == (!in_start && taken == W - 1));
            if (inside)
                pauses_where_drawn: assert (in_valid ? held == asks : held == 3'd0);
            if (in_valid && in_last)
                pauses_told: assert (pauses == paused_now);
            if (in_start && !entering_0)
                blanking_exact: assert (blank == due);
            if (in_start && entering_0)
                blanking_at_least: assert (first || blank >= before_0);
            if (BURST && was_running)
                always_enabled: assert (enable);
            if (!BURST && !inside && !in_valid && !first && !was_ready)
                rest_comes_out: assert (enable == (frame_over && blank < (blanking > REST ? blanking : REST)));
            if (first && !BURST)
                nothing_before: assert (!enable || in_start || was_ready);
            enters_soon: assert (held <= SOON);
            row_0_waits_for_nothing: assert (waited <= SOON + 1);
        end
endmodule

`default_nettype wire
