// The way of the rows around a stand-in for the core. The bench is the host and the dispatcher; it holds every ROW_OUT packet
// and every pixel clock between two rows against what the wire promises.
`default_nettype none

// Delays samples by W/2 + L pixel clocks and leaves them as they are.
module core_stand_in #(parameter L = 12) (
    input  wire        clk,
    input  wire        reset,
    input  wire        enable,
    input  wire [11:0] width,
    input  wire        prepare,
    input  wire [10:0] prepare_row,
    input  wire        prepare_bank,
    output reg         prepared,
    input  wire        in_valid,
    input  wire        in_start,
    input  wire [11:0] in_sample,
    output reg         out_valid,
    output reg         out_start,
    output reg         out_last,
    output reg  [11:0] out_sample
);
    reg [14:0] ring [0:4095];
    reg [11:0] now = 0;
    reg [10:0] prepared_row;
    reg        wanted = 0, unread = 0;
    integer    failures = 0, column = -1, since_start = 0, clocks_off = 0, multiplying = 0, i;

    // The rows that started, by their count: number, pixel clocks without a sample in front, bank of the tables.
    reg [15:0] rows = 0;
    reg [10:0] row_of [0:4095];
    reg        bank_of [0:4095];
    integer    blank_before [0:4095];

    task fail(input [8*40-1:0] what);
        begin
            failures = failures + 1;
            $display("FAIL %0s at %0t", what, $time);
        end
    endtask

    always @(posedge clk) begin
        if (in_valid && !enable)
            fail("a sample without enable");
        if (enable) begin
            if (in_valid != (in_start || (column >= 0 && column < width - 1)))
                fail("a row with a break");
            ring[now] = {in_valid, in_start, in_valid && column == width - 2, in_sample};
            {out_valid, out_start, out_last, out_sample} <= ring[(now - width / 2 - L + 1) & 4095];
            ring[(now - width / 2 - L + 1) & 4095] = 0;
            now <= now + 1;
            column <= in_start ? 0 : in_valid ? column + 1 : -1;
            since_start <= in_start ? 0 : since_start + 1;
            clocks_off <= in_valid ? 0 : clocks_off + 1;
            if (in_start) begin
                if (!prepared)
                    fail("a row that was not prepared");
                row_of[rows[11:0]] = prepared_row;
                blank_before[rows[11:0]] = clocks_off;
                rows <= rows + 1;
                prepared <= 0;
            end
        end
        if (multiplying > 0)
            multiplying <= multiplying - 1;
        if (multiplying == 1)
            prepared <= 1;
        if (since_start > width / 2)
            unread <= 0;
        if (enable && in_start)
            unread <= 1;
        if (wanted && !unread) begin
            wanted <= 0;
            multiplying <= 20;
        end
        if (prepare) begin
            if (wanted || multiplying != 0 || prepared)
                fail("two rows prepared");
            prepared_row <= prepare_row;
            bank_of[rows[11:0]] = prepare_bank;
            wanted <= 1;
        end
        if (reset) begin
            for (i = 0; i < 4096; i = i + 1)
                ring[i] = 0;
            out_valid <= 0;
            column <= -1;
            unread <= 0;
            multiplying <= 0;
            wanted <= 0;
            prepared <= 0;
        end
    end
endmodule

module halfrow_rows_bench;
    localparam L = 12;

    reg clk = 0;
    always #5 clk = !clk;

    reg         rst = 1, row_start = 0, acknowledge = 0, drop_rows = 0, new_session = 0;
    reg  [31:0] window = 0, drop_next_row = 0;
    reg  [15:0] packet_length = 0;
    reg  [11:0] width = 64, height = 4;
    reg  [15:0] blanking = 0;
    reg  [31:0] gap_seed = 0;
    reg  [1:0]  depth = 2;
    reg  [7:0]  generation = 1, commit_generation = 1, session = 1;
    reg         active_bank = 0, commit_pending = 0;
    reg  [15:0] commit_frame = 0;
    reg  [7:0]  packet_byte;
    reg         row_taken = 0, row_byte_ready = 0;
    wire        row_done, row_busy, frame_start, rows_waiting, rows_held, core_busy, shadow_in_use, quiet;
    wire        row_accepted, row_left, row_repeated, row_unneeded, sample_over, latency_valid;
    wire        row_valid, row_flag, row_byte_valid;
    wire        core_reset, prepare, prepare_bank, prepared, enables, in_valid, in_start, out_valid, out_start, out_last;
    reg         enable = 0;
    wire [3:0]  row_refusal;
    wire [7:0]  row_kind, row_session, row_byte;
    wire [10:0] prepare_row;
    wire [11:0] packet_address, in_sample, out_sample;
    wire [15:0] frame_number, row_sequence, row_length, first_latency, last_latency;
    wire [31:0] credit_window, acknowledged, next_row_in;

    halfrow_rows #(.TAPS(7)) rows (
        .clk(clk), .rst(rst), .row_start(row_start), .row_done(row_done), .row_refusal(row_refusal), .row_busy(row_busy),
        .packet_address(packet_address), .packet_byte(packet_byte), .packet_length(packet_length),
        .burst_request(1'b0), .burst_kind(2'd0), .expect_span(32'd0), .answer_begin(1'b0), .answer_next(1'b0), .answering(1'b0),
        .silence(1'b0), .configured(1'b1), .hold(1'b0),
        .acknowledge(acknowledge), .acknowledge_window(window), .drop_rows(drop_rows),
        .drop_next_row(drop_next_row), .new_session(new_session), .session(session), .width(width), .height(height),
        .blanking(blanking), .gap_seed(gap_seed), .depth(depth), .generation(generation), .active_bank(active_bank),
        .commit_pending(commit_pending), .commit_frame(commit_frame), .frame_start(frame_start),
        .frame_number(frame_number), .credit_window(credit_window), .acknowledged(acknowledged),
        .next_row_in(next_row_in), .rows_waiting(rows_waiting), .rows_held(rows_held), .core_busy(core_busy),
        .shadow_in_use(shadow_in_use), .quiet(quiet), .row_accepted(row_accepted), .row_left(row_left),
        .row_repeated(row_repeated), .row_unneeded(row_unneeded), .sample_over(sample_over),
        .latency_valid(latency_valid), .first_latency(first_latency), .last_latency(last_latency),
        .row_valid(row_valid), .row_kind(row_kind), .row_sequence(row_sequence), .row_length(row_length),
        .row_flag(row_flag), .row_session(row_session), .row_taken(row_taken), .row_byte_valid(row_byte_valid),
        .row_byte(row_byte), .row_byte_ready(row_byte_ready), .core_reset(core_reset), .prepare(prepare),
        .prepare_row(prepare_row), .prepare_bank(prepare_bank), .prepared(prepared), .enables(enables),
        .in_valid(in_valid), .in_start(in_start), .in_sample(in_sample), .out_valid(out_valid), .out_start(out_start),
        .out_last(out_last), .out_sample(out_sample), .core_enable(enable),
        .core_valid(in_valid), .core_start(in_start), .core_sample(in_sample),
        .pin_valid(out_valid), .pin_sample(out_sample));

    always @(posedge clk) enable <= enables;

    core_stand_in #(.L(L)) core (
        .clk(clk), .reset(core_reset || rst), .enable(enable), .width(width), .prepare(prepare),
        .prepare_row(prepare_row), .prepare_bank(prepare_bank), .prepared(prepared), .in_valid(in_valid),
        .in_start(in_start), .in_sample(in_sample), .out_valid(out_valid), .out_start(out_start), .out_last(out_last),
        .out_sample(out_sample));

    integer failures = 0, failures_before = 0;

    task expect_equal(input [8*40-1:0] what, input [31:0] got, input [31:0] wanted);
        if (got !== wanted) begin
            failures = failures + 1;
            if (failures <= 20)
                $display("FAIL %0s: %0d instead of %0d at %0t", what, got, wanted, $time);
        end
    endtask

    task passed(input [8*80-1:0] what);
        begin
            if (failures + core.failures == failures_before)
                $display("PASS %0s", what);
            failures_before = failures + core.failures;
        end
    endtask

    // ---- tables and counters of the dispatcher
    always @(posedge clk)
        if (frame_start && commit_pending && frame_number == commit_frame) begin
            commit_pending <= 0;
            generation <= commit_generation;
            active_bank <= !active_bank;
        end

    integer accepted = 0, left = 0, repeated = 0, unneeded = 0, over = 0;

    always @(posedge clk) if (!rst) begin
        accepted = accepted + row_accepted;
        left = left + row_left;
        repeated = repeated + row_repeated;
        unneeded = unneeded + row_unneeded;
        over = over + sample_over;
        if (row_left)
            expect_equal("latency of a row that left", {first_latency, last_latency}, {2{16'd12 + width[11:1]}});
        if (latency_valid !== row_left)
            expect_equal("latency_valid", latency_valid, row_left);
    end

    // ---- the receiver's buffer
    reg [7:0] packet [0:4095];

    always @(posedge clk)
        packet_byte <= packet[packet_address];

    function [11:0] sample_of(input [31:0] number, input integer column);
        reg [31:0] product;
        begin
            product = (number * 4099 + column + 1) * 32'd2654435761;
            sample_of = product[31:20];
        end
    endfunction

    // ---- the sender: takes packets, and judges them; one whose row is dropped meanwhile comes whole all the same
    integer    ready_percent = 100, at = -1, length = 0, packets = 0, received = 0, column, asks;
    reg [7:0]  bytes [0:4095];
    reg [31:0] number = 0, next_new = 0;
    reg [15:0] frame_of [0:15], row_of [0:15];
    reg [7:0]  generation_of [0:15];
    reg [11:0] width_of [0:15];
    reg        last_of [0:15];
    integer    repeats_of [0:15], pauses_of [0:15], pauses [0:2047], extra [0:2047];
    reg [23:0] pair;

    always @(negedge clk) begin
        row_byte_ready = ($random & 127) * 100 < ready_percent * 128;
        row_taken = row_valid && at < 0 && ($random & 127) * 100 < ready_percent * 128;
    end

    always @(posedge clk) begin
        if (at < 0 && row_byte_ready && row_byte_valid)
            expect_equal("bytes behind a packet's end", 1, 0);
        if (at >= 0 && row_byte_ready && row_byte_valid) begin
            bytes[at] = row_byte;
            at = at + 1;
            if (at == length) begin
                judge_row;
                received = received + 1;
                at = -1;
            end
        end else if (row_taken && row_valid) begin
            expect_equal("kind, flag", {row_kind, 7'd0, row_flag}, 16'h2100);
            expect_equal("payload", row_length, 24 + width / 2 * 3);
            expect_equal("number of the packet", row_sequence, packets[15:0]);
            packets = packets + 1;
            length = row_length;
            at = 0;
        end
        if (drop_rows && new_session)
            packets = 0;
    end

    task judge_row;
        begin
            number = {bytes[3], bytes[2], bytes[1], bytes[0]};
            expect_equal("frame", {bytes[5], bytes[4]}, frame_of[number[3:0]]);
            expect_equal("row", {bytes[7], bytes[6]}, row_of[number[3:0]]);
            expect_equal("width", {bytes[9], bytes[8]}, width_of[number[3:0]]);
            expect_equal("bytes", length, 24 + width_of[number[3:0]] / 2 * 3);
            expect_equal("flags", bytes[10], last_of[number[3:0]]);
            expect_equal("generation", bytes[11], generation_of[number[3:0]]);
            expect_equal("first latency", {bytes[13], bytes[12]}, width_of[number[3:0]] / 2 + L);
            expect_equal("last latency", {bytes[15], bytes[14]}, width_of[number[3:0]] / 2 + L);
            expect_equal("pauses", {bytes[17], bytes[16]}, pauses_of[number[3:0]]);
            expect_equal("repeats", {bytes[19], bytes[18]}, repeats_of[number[3:0]]);
            repeats_of[number[3:0]] = repeats_of[number[3:0]] + (repeats_of[number[3:0]] != 65535);
            for (column = 0; column < width_of[number[3:0]]; column = column + 2) begin
                pair = {bytes[22 + column / 2 * 3], bytes[21 + column / 2 * 3], bytes[20 + column / 2 * 3]};
                expect_equal("samples", pair, {sample_of(number, column + 1), sample_of(number, column)});
            end
            expect_equal("entered", {bytes[length - 1], bytes[length - 2], bytes[length - 3], bytes[length - 4]},
                         crc_of(number, width_of[number[3:0]]));
            if (number == next_new)
                next_new = next_new + 1;
        end
    endtask

    // CRC-32 of a row's samples as words of 16 bits, bit by bit.
    function [31:0] crc_of(input [31:0] of_row, input integer samples);
        integer   c, i;
        reg [15:0] word;
        begin
            crc_of = 32'hffffffff;
            for (c = 0; c < samples; c = c + 1) begin
                word = sample_of(of_row, c);
                for (i = 0; i < 16; i = i + 1)
                    crc_of = {1'b0, crc_of[31:1]} ^ (crc_of[0] ^ word[i] ? 32'hedb88320 : 32'd0);
            end
            crc_of = ~crc_of;
        end
    endfunction

    `include "halfrow_rows_host.vh"
    `include "halfrow_rows_cases.vh"
endmodule

`default_nettype wire
