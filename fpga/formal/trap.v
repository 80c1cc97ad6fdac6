// halfrow_trap under rows that end at any time, with any signatures, and EXPECTs between bursts: it keeps the first row whose
// signature is not the expected one, with its samples, and what is kept never changes before it is emptied. The monitor compares
// whole words, in the clock in which a row's signature is there.
`default_nettype none

module trap #(
    parameter HEIGHT = 2
) (
    input wire        clk,
    input wire        wants_reset,
    input wire        wants_empty,
    input wire        wants_sample,
    input wire        wants_compare,
    input wire        wants_expect,
    input wire        wants_told,
    input wire        wants_begin,
    input wire        wants_byte,
    input wire        is_last_row,
    input wire [1:0]  any_first,
    input wire [1:0]  any_count,
    input wire [7:0]  packet_byte,
    input wire [11:0] sample,
    input wire [31:0] any_signature
);
    localparam SETTLE = 9; // clocks behind a row's end in which it is compared

    reg running = 1'b0;
    always @(posedge clk) running <= 1'b1;
    wire rst = !running || wants_reset;

    wire ready, kept;
    wire [31:0] frame, signature;
    wire [11:0] row, read_sample;
    wire column;

    // Rows of two samples, ten clocks apart at least; none beside an EXPECT.
    reg second, compares;
    reg [3:0] since; // clocks behind a row's end
    reg [3:0] expecting;
    reg [1:0] first, count; // of an EXPECT, up to its end
    wire settled = since >= SETTLE;
    wire given = ready && wants_sample && expecting == 4'd0 && (second || settled) && !wants_empty;
    wire ends = given && second;
    wire expect_start = ready && wants_expect && !second && settled && expecting == 4'd0;
    wire takes = {1'b0, first} + {1'b0, count} <= HEIGHT;
    reg [31:0] row_signature;
    reg frame_left;

    halfrow_trap dut (
        .clk(clk), .rst(rst), .ready(ready), .expect_start(expect_start), .first({14'd0, first}),
        .count({14'd0, count}), .packet_length(12'd20), .packet_byte(packet_byte), .trap_start(wants_told),
        .reply_begins(wants_begin), .reply_advance(wants_byte && kept), .under_way(1'b0), .compares(compares),
        .empty(wants_empty), .width(12'd2), .height(HEIGHT), .sample_bytes(12'd3), .given(given), .last(second),
        .sample(sample), .row_signature(row_signature), .frame_left(frame_left), .kept(kept), .frame(frame),
        .signature(signature), .row(row), .read_sample(read_sample), .column(column));

    always @(posedge clk)
        if (rst) begin
            {second, compares, expecting} <= 6'd0;
            since <= 4'd15;
        end else begin
            second <= given ? !second : second && !wants_empty;
            if (!second && settled && !given)
                compares <= wants_compare;
            since <= ends ? 4'd0 : since == 4'd15 ? 4'd15 : since + 4'd1;
            if (expecting == 4'd0 && !expect_start)
                {first, count} <= {any_first, any_count};
            expecting <= expect_start ? 4'd15 : expecting - (expecting != 4'd0);
            if (ends) begin
                row_signature <= any_signature;
                frame_left <= is_last_row;
            end
        end

    // What is expected: the first signature's first byte comes two clocks behind the start.
    reg [63:0] expected;
    reg [1:0] left;
    reg at_row;
    reg [1:0] at_byte;
    reg soon;

    always @(posedge clk) begin
        soon <= expect_start && takes;
        if (rst) begin
            expected <= 64'd0;
            {left, soon} <= 3'd0;
        end else if (expect_start && takes) begin
            left <= count;
            {at_row, at_byte} <= {first[0], 2'd0};
        end else if (left != 2'd0 && !soon) begin
            expected[{at_row, at_byte, 3'd0} +: 8] <= packet_byte;
            {at_row, at_byte} <= {at_row, at_byte} + 3'd1;
            left <= left - (at_byte == 2'd3);
        end
    end

    // What must be kept.
    reg is_kept, looks;
    reg [31:0] in_frame, kept_signature;
    reg [11:0] in_row_number;
    reg [11:0] samples [0:1];
    reg [11:0] kept_samples [0:1];
    wire is_other = in_row_number < HEIGHT && row_signature != expected[{in_row_number[0], 5'd0} +: 32];

    always @(posedge clk) begin
        looks <= ends && compares && !wants_empty;
        if (given)
            samples[second] <= sample;
        if (looks && !is_kept)
            if (is_other) begin
                is_kept <= 1'b1;
                kept_signature <= row_signature;
                {kept_samples[0], kept_samples[1]} <= {samples[0], samples[1]};
            end else if (frame_left) begin
                in_row_number <= 12'd0;
                in_frame <= in_frame + 32'd1;
            end else if (in_row_number < HEIGHT)
                in_row_number <= in_row_number + 12'd1;
        if (rst || wants_empty) begin
            {is_kept, looks} <= 2'b00;
            {in_row_number, in_frame} <= 44'd0;
        end
    end

    // And stay.
    reg was_kept, was_column;
    reg [1:0] keeps; // for so many clocks
    reg [75:0] was;

    always @(posedge clk) begin
        was_kept <= kept && !rst && !wants_empty;
        was <= {frame, row, signature};
        was_column <= column;
        keeps <= !kept || rst || wants_empty ? 2'd0 : keeps[1] ? 2'd2 : keeps + 2'd1;
    end

    always @(posedge clk)
        if (running && !rst) begin
            if (was_kept)
                stays: assert (kept && was == {frame, row, signature});
            if (settled)
                first_alone: assert (kept == is_kept);
            if (kept && settled)
                its_name: assert ({frame, row, signature} == {in_frame, in_row_number, kept_signature});
            if (keeps[1] && is_kept)
                its_samples: assert (read_sample == kept_samples[was_column]);
        end
endmodule

`default_nettype wire
