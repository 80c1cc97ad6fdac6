// The way of the rows: from ROW_IN packets through the in-banks, the player, the core, the collector and the
// out-banks to ROW_OUT packets; and the rows that a burst makes instead, which go no further than the core.
`default_nettype none

module halfrow_rows #(
    parameter MAX_HEIGHT = 2048,
    parameter ROW_BITS = 11,
    parameter COLUMN_BITS = 11, // 2 ** COLUMN_BITS samples a bank, at least the widest row's
    parameter TAPS = 7,
    parameter TABLE_BANKS = 2,
    parameter ROW_BANKS_IN = 2, // both powers of two, 2 to 64
    parameter ROW_BANKS_OUT = 2,
    parameter TRAP = 1          // there is one
) (
    input  wire                clk,
    input  wire                rst,

    // a ROW_IN packet of the open session, in the receiver's buffer from row_start to row_done
    input  wire                row_start,
    output wire                row_done,
    output wire [3:0]          row_refusal,   // with row_done: a code, or 0
    output wire                row_busy,
    output wire [11:0]         packet_address,
    input  wire [7:0]          packet_byte,   // one clock behind its address
    input  wire [15:0]         packet_length,

    // a BURST, RECORDS, EXPECT or TRAP, likewise, from burst_request to burst_done
    output wire                burst_ready,   // high once such may come
    input  wire                burst_request,
    input  wire [1:0]          burst_kind,    // which it is, numbered so
    input  wire [31:0]         expect_span,   // of an EXPECT, whose first signature is read: its first row, their count
    output wire                burst_rewind,
    output wire                burst_advance,
    output wire                burst_done,
    output wire [3:0]          burst_refusal,
    output wire [15:0]         burst_detail,
    output wire [11:0]         answer_length, // bytes of the reply to RECORDS or TRAP
    input  wire                answer_begin,  // pulse: its first byte is wanted
    input  wire                answer_next,  // the next one is
    input  wire                answering,     // it is under way
    output wire [7:0]          answer_byte,  // two clocks later, 0 unless it is
    output wire                burst,         // one is under way
    input  wire                silence,       // pulse: it ends, and no row is dropped

    input  wire                hold,          // no further row starts: a request is carried out
    input  wire                acknowledge,   // pulse
    input  wire [31:0]         acknowledge_window,
    input  wire                drop_rows,     // pulse
    input  wire [31:0]         drop_next_row,
    input  wire                new_session,   // with drop_rows
    input  wire [7:0]          session,

    // change only while no row is in a bank or in the core
    input  wire [11:0]         width,
    input  wire [11:0]         height,
    input  wire [15:0]         blanking,
    input  wire [31:0]         gap_seed,
    input  wire [1:0]          depth,         // 0: 8 bits, 1: 10, 2: 12

    input  wire                configured,
    input  wire [7:0]          generation,
    input  wire                active_bank,
    input  wire                commit_pending,
    input  wire [15:0]         commit_frame,
    output wire                frame_start,   // pulse: row 0 of frame_number is prepared next
    output wire [15:0]         frame_number,

    output wire [31:0]         credit_window,
    output wire [31:0]         acknowledged,
    output wire [31:0]         next_row_in,
    output wire                rows_waiting,  // a row is in an in-bank
    output wire                rows_held,     // a row is in an out-bank
    output wire                core_busy,     // a row is inside the core, or about to be
    output wire                shadow_in_use, // tables must not be written
    output wire                quiet,         // nothing will happen without new input

    output wire                row_accepted,  // pulses
    output wire                row_left,
    output wire                row_repeated,
    output wire                row_unneeded,
    output wire                sample_over,
    output wire                latency_valid,
    output wire [15:0]         first_latency,
    output wire [15:0]         last_latency,

    // to the sender
    output wire                row_valid,
    output wire [7:0]          row_kind,
    output wire [15:0]         row_sequence,
    output wire [15:0]         row_length,
    output wire                row_flag,
    output wire [7:0]          row_session,
    input  wire                row_taken,
    output wire                row_byte_valid,
    output wire [7:0]          row_byte,
    input  wire                row_byte_ready,

    // to the core
    output wire                core_reset,
    output wire                prepare,
    output wire [ROW_BITS-1:0] prepare_row,
    output wire                prepare_bank,
    input  wire                prepared,
    output wire                enables,       // the core's enable of the next clock
    output wire                in_valid,
    output wire                in_start,
    output wire [11:0]         in_sample,
    input  wire                out_valid,
    input  wire                out_start,
    input  wire                out_last,
    input  wire [11:0]         out_sample,
    input  wire                core_enable,
    input  wire                core_valid,    // what stands at the core's pins
    input  wire                core_start,
    input  wire [11:0]         core_sample,
    output wire                frame_valid,   // of a burst's frames, as a sensor would have it at the core's pins
    input  wire                pin_valid,     // what the image processor gets
    input  wire [11:0]         pin_sample
);
    `include "halfrow_board.vh"

    generate // what a build cannot have
        if (MAX_HEIGHT < 1 || MAX_HEIGHT > GREATEST_HEIGHT) halfrow_illegal_MAX_HEIGHT is_1_to_2048 ();
        if (ROW_BITS < 1 || ROW_BITS > 16) halfrow_illegal_ROW_BITS is_1_to_16 ();
        if (COLUMN_BITS < 6 || COLUMN_BITS > 12) halfrow_illegal_COLUMN_BITS is_6_to_12 ();
        if (TAPS != 5 && TAPS != 7) halfrow_illegal_TAPS is_5_or_7 ();
        if (TABLE_BANKS != 1 && TABLE_BANKS != 2) halfrow_illegal_TABLE_BANKS is_1_or_2 ();
        if (ROW_BANKS_IN < 2 || ROW_BANKS_IN > 64 || (ROW_BANKS_IN & (ROW_BANKS_IN - 1)) != 0)
            halfrow_illegal_ROW_BANKS_IN is_a_power_of_two_from_2_to_64 ();
        if (ROW_BANKS_OUT < 2 || ROW_BANKS_OUT > 64 || (ROW_BANKS_OUT & (ROW_BANKS_OUT - 1)) != 0)
            halfrow_illegal_ROW_BANKS_OUT is_a_power_of_two_from_2_to_64 ();
        if (TRAP != 0 && TRAP != 1) halfrow_illegal_TRAP is_0_or_1 ();
    endgenerate

    localparam IN_BITS = bits_for(ROW_BANKS_IN);
    localparam OUT_BITS = bits_for(ROW_BANKS_OUT);
    // Rows between acknowledgement and credit are at most as many as there are banks of both kinds.
    localparam ENTRY_BITS = (IN_BITS > OUT_BITS ? IN_BITS : OUT_BITS) + 1;
    localparam [ENTRY_BITS-1:0] BANKS_OUT = {{ENTRY_BITS-1{1'b0}}, 1'b1} << OUT_BITS;

    wire clear = rst || drop_rows;
    wire bursting, burst_ends;
    reg restarting; // a clock behind rst, on which too much hangs
    wire clear_core = restarting || drop_rows || burst_ends; // nothing is inside it

    always @(posedge clk)
        restarting <= rst;

    reg [COLUMN_BITS-1:0] last_column;
    always @(posedge clk) last_column <= width[COLUMN_BITS-1:0] - 1'b1;

    wire settling, arrived, in_last, leaves, sent, played;
    wire [ENTRY_BITS-1:0] rows_entered, rows_left, rows_sent, first_unentered, leaving_entry, unsent_entry;
    wire [ROW_BANKS_IN-1:0] waiting;
    wire [ENTRY_BITS-1:0] gate_entry;

    halfrow_row_numbers #(.IN_BITS(IN_BITS), .ENTRY_BITS(ENTRY_BITS)) numbers (
        .clk(clk), .rst(rst), .drop(drop_rows), .drop_next_row(drop_next_row),
        .acknowledge(acknowledge), .acknowledge_window(acknowledge_window), .settling(settling),
        .arrived(arrived), .arrived_bank(gate_entry[IN_BITS-1:0]),
        .entered(in_last && !burst), .left(leaves), .sent(sent),
        .acknowledged(acknowledged), .credit_window(credit_window), .next_row_in(next_row_in),
        .rows_entered(rows_entered), .rows_left(rows_left), .rows_sent(rows_sent), .next_entry(first_unentered),
        .leaving_entry(leaving_entry), .unsent_entry(unsent_entry),
        .waiting(waiting), .played(played));

    wire place_write, place_held;
    wire [2:0] place_index, before_index;
    wire [ENTRY_BITS-1:0] before_entry;
    wire [7:0] place_byte, before_byte, prepare_byte, send_byte;
    wire [ENTRY_BITS+2:0] prepare_address, send_address;

    halfrow_row_places #(.ENTRY_BITS(ENTRY_BITS)) places (
        .clk(clk), .write(place_write), .write_address({gate_entry, place_index}), .write_byte(place_byte),
        .check_address({before_entry, before_index}), .check_byte(before_byte),
        .prepare_address(prepare_address), .prepare_byte(prepare_byte),
        .send_address(send_address), .send_byte(send_byte));

    wire sample_in_write, again, again_waiting;
    wire [COLUMN_BITS-1:0] column_in;
    wire [11:0] sample_in;

    halfrow_row_gate #(
        .IN_BITS(IN_BITS), .ENTRY_BITS(ENTRY_BITS), .COLUMN_BITS(COLUMN_BITS)
    ) gate (
        .clk(clk), .rst(clear), .row_start(row_start), .row_done(row_done), .row_refusal(row_refusal), .busy(row_busy),
        .packet_address(packet_address), .packet_byte(packet_byte), .packet_length(packet_length[11:0]),
        .width(width), .height(height), .last_column(last_column), .depth(depth), .burst(burst),
        .has_generation(generation != 8'd0), .commit_pending(commit_pending), .commit_frame(commit_frame),
        .settling(settling), .acknowledged(acknowledged), .rows_entered(rows_entered), .rows_left(rows_left),
        .waiting(waiting), .played(played),
        .place_write(place_write), .entry(gate_entry), .place_index(place_index), .place_byte(place_byte),
        .places_held(place_held),
        .before_entry(before_entry), .before_index(before_index), .before_byte(before_byte),
        .sample_write(sample_in_write), .column(column_in), .sample(sample_in),
        .again(again), .again_waiting(again_waiting),
        .accepted(arrived), .unneeded(row_unneeded), .sample_over(sample_over));

    assign row_accepted = arrived;
    assign row_repeated = again;

    // The row that starts next, which is there if it is in its bank and the one that it goes to is free.
    wire under_way, wanted_held;
    wire [ENTRY_BITS-1:0] next_entry = first_unentered + {{ENTRY_BITS-1{1'b0}}, under_way};
    wire [ENTRY_BITS-1:0] rows_started = rows_entered + {{ENTRY_BITS-1{1'b0}}, under_way};
    wire row_there = waiting[next_entry[IN_BITS-1:0]] && rows_started < BANKS_OUT && !wanted_held;

    wire preparer_busy, row_ready, start, next_row_0, next_is_last, burst_row_there, burst_other;
    wire [11:0] burst_row;
    wire [7:0] next_generation;
    wire [ENTRY_BITS-1:0] ready_entry;

    halfrow_preparer #(.ROW_BITS(ROW_BITS), .ENTRY_BITS(ENTRY_BITS)) preparer (
        .clk(clk), .rst(clear_core), .row_there(burst ? burst_row_there : row_there && !hold), .next_entry(next_entry),
        .height(height), .place_address(prepare_address), .place_byte(prepare_byte),
        .burst(burst), .burst_row(burst_row), .burst_other(burst_other),
        .frame_start(frame_start), .frame_number(frame_number), .generation(generation), .active_bank(active_bank),
        .prepare(prepare), .prepare_row(prepare_row), .prepared(prepared),
        .ready(row_ready), .start(start), .entry(ready_entry), .row_0(next_row_0), .row_is_last(next_is_last),
        .row_generation(next_generation), .row_bank(prepare_bank), .busy(preparer_busy));

    wire sample_in_read, flushing, enable, ends_frame, due, draws_first;
    wire [31:0] first_draw, draw;
    wire [15:0] frame_blanking;
    wire [COLUMN_BITS-1:0] column_played;
    wire [15:0] pauses;

    halfrow_player #(.TAPS(TAPS), .COLUMN_BITS(COLUMN_BITS)) player (
        .clk(clk), .rst(clear_core), .width(width), .blanking(blanking),
        .burst(burst), .frame_blanking(frame_blanking), .seed(first_draw),
        .row_ready(row_ready), .row_0(next_row_0), .row_is_last(next_is_last), .start(start),
        .sample_read(sample_in_read), .column(column_played), .draws_first(draws_first), .draw(draw),
        .enables(enables), .enable(enable), .in_valid(in_valid), .in_start(in_start), .in_last(in_last),
        .pauses(pauses),
        .under_way(under_way), .flushing(flushing), .ends_frame(ends_frame), .due(due));

    reg [IN_BITS-1:0] played_bank;
    wire [11:0] sample_played, sample_made;
    wire [31:0] burst_seed;
    wire [15:0] burst_frame;

    always @(posedge clk)
        if (start)
            played_bank <= ready_entry[IN_BITS-1:0];

    halfrow_row_bank #(.ADDRESS_BITS(IN_BITS + COLUMN_BITS)) in_banks (
        .clk(clk), .write(sample_in_write), .write_address({gate_entry[IN_BITS-1:0], column_in}),
        .write_sample(sample_in), .read(sample_in_read),
        .read_address({start ? ready_entry[IN_BITS-1:0] : played_bank, column_played}), .read_sample(sample_played));

    halfrow_content content (
        .clk(clk), .burst(bursting), .depth(depth), .seed(burst_seed), .frame(burst_frame), .row(burst_row),
        .gap_seed(gap_seed), .first(first_draw), .begins_row(draws_first), .enters(sample_in_read),
        .row_starts(start), .column(column_played[3:0]), .draw(draw), .sample(sample_made));

    assign in_sample = bursting ? sample_made : sample_played;

    wire sample_out_write, row_inside, other_tables, row_measured;
    wire [COLUMN_BITS-1:0] column_collected, column_sent;
    wire [OUT_BITS-1:0] left_bank, sent_bank;
    wire [15:0] left_pauses;

    halfrow_collector #(.OUT_BITS(OUT_BITS), .COLUMN_BITS(COLUMN_BITS)) collector (
        .clk(clk), .rst(clear_core), .burst(burst), .start(start), .start_bank(ready_entry[OUT_BITS-1:0]),
        .start_tables(prepare_bank),
        .active_bank(active_bank), .enable(enable), .in_valid(in_valid), .in_start(in_start), .in_last(in_last),
        .pauses(pauses),
        .out_valid(burst ? pin_valid : out_valid), .out_start(out_start), .out_last(out_last),
        .leaving_bank(leaving_entry[OUT_BITS-1:0]), .sample_write(sample_out_write), .column(column_collected),
        .leaves(leaves), .row_left(row_measured), .left_bank(left_bank), .first_latency(first_latency),
        .last_latency(last_latency), .left_pauses(left_pauses), .row_inside(row_inside), .other_tables(other_tables));

    assign row_left = row_measured && !burst;
    assign latency_valid = row_left;

    wire [3:0] head_index;
    wire [31:0] entered;
    wire [7:0] head_byte, counted_byte;
    wire counted, counted_high;

    halfrow_row_heads #(.OUT_BITS(OUT_BITS)) heads (
        .clk(clk), .rst(rst), .start(start), .start_bank(ready_entry[OUT_BITS-1:0]), .width(width),
        .start_is_last(next_is_last), .start_generation(next_generation), .left(row_left), .left_bank(left_bank),
        .first_latency(first_latency), .last_latency(last_latency), .pauses(left_pauses), .entered(entered),
        .bank(sent_bank),
        .index(head_index), .value(head_byte), .replace(counted),
        .replace_high(counted_high), .replacement(counted_byte));

    wire sample_out_read;
    wire [11:0] sample_sent;

    halfrow_row_bank #(.ADDRESS_BITS(OUT_BITS + COLUMN_BITS)) out_banks (
        .clk(clk), .write(sample_out_write), .write_address({leaving_entry[OUT_BITS-1:0], column_collected}),
        .write_sample(out_sample), .read(sample_out_read), .read_address({sent_bank, column_sent}),
        .read_sample(sample_sent));

    wire sender_idle;
    wire [11:0] sample_bytes;

    halfrow_row_sender #(
        .OUT_BITS(OUT_BITS), .ENTRY_BITS(ENTRY_BITS), .COLUMN_BITS(COLUMN_BITS)
    ) row_sender (
        .clk(clk), .rst(rst), .drop(drop_rows), .new_session(new_session), .session(session), .width(width),
        .sample_bytes(sample_bytes), .unsent(rows_left != rows_sent), .unsent_entry(unsent_entry), .sent(sent),
        .again(again), .again_entry(gate_entry), .again_waiting(again_waiting),
        .wanted_bank(next_entry[OUT_BITS-1:0]), .wanted_held(wanted_held), .place_held(place_held),
        .place_address(send_address), .place_byte(send_byte), .bank(sent_bank),
        .head_index(head_index), .head_byte(head_byte), .counted(counted), .counted_high(counted_high),
        .counted_byte(counted_byte),
        .sample_read(sample_out_read), .column(column_sent), .read_sample(sample_sent),
        .row_valid(row_valid), .row_kind(row_kind), .row_sequence(row_sequence), .row_length(row_length),
        .row_flag(row_flag), .row_session(row_session), .row_taken(row_taken),
        .row_byte_valid(row_byte_valid), .row_byte(row_byte), .row_byte_ready(row_byte_ready), .idle(sender_idle));

    wire burst_alternates, burst_quiet;
    reg ready_for_burst, busy_for_burst;

    always @(posedge clk) begin
        ready_for_burst <= configured && generation != 8'd0;
        busy_for_burst <= rows_waiting || rows_held || core_busy || commit_pending;
    end

    halfrow_burst #(
        .MAX_HEIGHT(MAX_HEIGHT), .COLUMN_BITS(COLUMN_BITS), .TABLE_BANKS(TABLE_BANKS), .TRAP(TRAP)
    ) bursts (
        .clk(clk), .rst(restarting), .requests_ready(burst_ready), .request_start(burst_request),
        .request_kind(burst_kind), .expect_first(expect_span[15:0]), .expect_count(expect_span[31:16]),
        .packet_length(packet_length[11:0]), .width(width), .height(height), .sample_bytes(sample_bytes),
        .rewind(burst_rewind), .advance(burst_advance), .packet_byte(packet_byte), .request_done(burst_done),
        .refusal(burst_refusal), .detail(burst_detail), .ready(ready_for_burst), .busy(busy_for_burst),
        .reply_length(answer_length), .reply_begins(answer_begin), .reply_advance(answer_next),
        .replying(answering), .reply_byte(answer_byte), .burst(burst), .bursting(bursting),
        .ends(burst_ends), .drop(drop_rows || silence), .forget(drop_rows && new_session), .quiet(burst_quiet),
        .generation(generation), .row_there(burst_row_there), .row(burst_row), .other_tables(burst_other),
        .seed(burst_seed), .frame(burst_frame), .frame_blanking(frame_blanking), .alternates(burst_alternates),
        .preparing(preparer_busy), .row_ready(row_ready), .row_is_last(next_is_last), .due(due), .start(start),
        .in_last(in_last), .ends_frame(ends_frame), .frame_valid(frame_valid), .core_valid(core_valid),
        .core_start(core_start), .core_sample(core_sample), .row_signature(entered), .enable(core_enable),
        .pin_valid(pin_valid), .pin_last(out_last), .pin_sample(pin_sample), .first_latency(first_latency),
        .last_latency(last_latency));

    assign core_reset = drop_rows || burst_ends;
    assign rows_waiting = waiting != {ROW_BANKS_IN{1'b0}};
    assign rows_held = row_inside || rows_left != {ENTRY_BITS{1'b0}};
    assign core_busy = row_inside || preparer_busy || burst;
    assign shadow_in_use = TABLE_BANKS == 1 ? core_busy : other_tables || burst_alternates;
    assign quiet = !row_busy && !settling && !row_there && !preparer_busy && !under_way && !flushing
                   && (burst || !enable) && sender_idle && burst_quiet;

    wire unused = &{1'b0, packet_length[15:12], ready_entry, leaving_entry};
endmodule

`default_nettype wire
