// Bursts, fpga/AT-SPEED.md: which row of which frame the board makes next and with which tables, what leaves of them at
// the image processor's pins, and what a host asks of both.
`default_nettype none

module halfrow_burst #(
    parameter MAX_HEIGHT = 2048,
    parameter COLUMN_BITS = 11,
    parameter TABLE_BANKS = 2,
    parameter TRAP = 1 // there is one
) (
    input  wire        clk,
    input  wire        rst,

    // a BURST, RECORDS, EXPECT or TRAP of the open session
    output wire        requests_ready, // high once requests may come
    input  wire        request_start, // pulse: it lies in the receiver's buffer, up to request_done
    input  wire [1:0]  request_kind,  // which it is, numbered so
    input  wire [15:0] expect_first,  // of an EXPECT, whose first signature is read
    input  wire [15:0] expect_count,
    input  wire [11:0] packet_length,
    output wire        rewind,        // pulse: its payload is read from the first byte on
    output wire        advance,       // by one byte
    input  wire [7:0]  packet_byte,   // one clock behind its address
    output wire        request_done,  // pulse: with what follows
    output wire [3:0]  refusal,       // a code, or 0
    output wire [15:0] detail,
    input  wire        ready,         // there are a configuration and tables
    input  wire        busy,          // rows are in the board, a commit waits, or a burst is under way
    output wire [11:0] reply_length,  // bytes of the payload of the reply to RECORDS or TRAP
    input  wire        reply_begins,  // pulse: its first byte is wanted
    input  wire        reply_advance, // the next one is
    input  wire        replying,      // it is such a reply that is under way
    output wire [7:0]  reply_byte,    // two clocks later, 0 unless `replying`

    output reg         burst,         // one is under way
    output reg         bursting,      // a clock later, for what takes a row's samples from one side or the other
    output reg         ends,          // pulse: it was, up to the clock before
    input  wire        drop,          // pulse: it ends at once
    input  wire        forget,        // with drop: there is none of this session
    output wire        quiet,         // nothing will happen without new input

    // to the rows' way
    input  wire [11:0] width,
    input  wire [11:0] height,
    input  wire [11:0] sample_bytes,  // of a row, packed
    input  wire [7:0]  generation,
    output wire        row_there,     // `row` may be prepared
    output reg  [11:0] row,           // that starts next
    output wire        other_tables,  // it is made with those of the bank that is not active
    output wire [31:0] seed,
    output reg  [15:0] frame,         // its number
    output wire [15:0] frame_blanking,
    output wire        alternates,    // rows use both banks
    input  wire        preparing,     // a row is prepared, or waits to start
    input  wire        row_ready,     // it waits
    input  wire        row_is_last,   // it ends its frame
    input  wire        due,           // no blanking is left
    input  wire        start,         // pulse: it starts
    input  wire        in_last,       // at the core's pins
    input  wire        ends_frame,    // the row at the pins is a frame's last
    output reg         frame_valid,   // as a sensor would have it at the core's pins

    // what leaves of a burst, and what enters of other rows
    input  wire        core_valid,    // a sample stands at the core's pins
    input  wire        core_start,    // and is its row's first
    input  wire [11:0] core_sample,
    output wire [31:0] row_signature, // of the row that entered last, for 63 clocks
    input  wire        enable,        // the core's
    input  wire        pin_valid,     // an output stands at the pins
    input  wire        pin_last,      // and is its row's last
    input  wire [11:0] pin_sample,
    input  wire [15:0] first_latency, // of the row, one clock later
    input  wire [15:0] last_latency
);
    `include "halfrow_wire.vh"
    `include "halfrow_board.vh"

    localparam [8:0] HEAD_BYTES = 9'd10;
    localparam [1:0] ALTERNATING = 2'd1, TRAPPED = 2'd3;
    localparam [1:0] NO_BURST = 2'd0, UNDER_WAY = 2'd1, ENDED = 2'd2;

    wire starts, more, free, recorded, signed_all, ledger_idle, named;
    wire [1:0] mode;
    wire [15:0] first_frame;
    reg [1:0] frames_inside; // frames that have begun and have no record
    reg started; // pulse: a row has
    wire frame_begins = started && row == 12'd0;
    wire frame_ends = started && row_is_last; // of its rows none is left to start
    wire over = burst && !more && !preparing && !started && frames_inside == 2'd0;

    assign row_there = burst && !started && (row != 12'd0 || (more && free));

    always @(posedge clk) begin
        burst <= !rst && !drop && (starts || (burst && !over));
        bursting <= burst;
        ends <= burst && (over || drop);
        started <= burst && start && !drop;
        if (rst || starts || drop)
            frames_inside <= 2'd0;
        else
            frames_inside <= frames_inside + {1'b0, frame_begins} - {1'b0, recorded};
    end

    // What enters. Of two frames one after the other one is odd.
    reg odd, odd_leaves;

    assign alternates = burst && mode == ALTERNATING;
    assign other_tables = alternates && odd;

    always @(posedge clk) begin
        if (starts)
            row <= 12'd0;
        else if (started)
            row <= row_is_last ? 12'd0 : row + 12'd1;
        if (starts)
            frame <= first_frame;
        else
            frame <= frame + {15'd0, frame_ends && !mode[1]};
        odd <= !starts && odd ^ frame_ends;
        odd_leaves <= !starts && odd_leaves ^ recorded;
        frame_valid <= burst && !drop && (start || (frame_valid && !(in_last && ends_frame)));
    end

    // A frame that does not start when its blanking has passed was held back.
    reg follows, late, held_entering, held_leaving;

    always @(posedge clk) begin
        follows <= !starts && (follows || frame_begins);
        late <= !frame_begins && (late || (due && row == 12'd0 && !row_ready)) && follows && !starts;
        if (frame_begins)
            held_entering <= late;
        if (frame_begins && (frames_inside == 2'd0 || (recorded && !frames_inside[1])))
            held_leaving <= late;
        else if (recorded)
            held_leaving <= held_entering;
    end

    // What leaves. A pause while two frames are inside is in front of the newer one's first output, too.
    reg given, entering, signed_last, ended_leaves, closing, stopped, stopped_early, early;
    reg [11:0] signed_sample;
    // What enters is signed a clock later: it comes late in the clock, out of a memory and through multiplexers.
    reg entered_valid, entered_start, entered_last;
    reg [11:0] entered_sample;
    wire row_left = given && signed_last;

    always @(posedge clk) begin
        given <= burst && enable && pin_valid;
        {entered_valid, entered_start, entered_last} <= {core_valid, core_start, in_last};
        entered_sample <= core_sample;
        entering <= !bursting && entered_valid;
        signed_last <= bursting ? pin_last : entered_last;
        signed_sample <= bursting ? pin_sample : entered_sample;
        if (in_last)
            ended_leaves <= ends_frame;
        closing <= frames_inside != 2'd0 && !recorded && (closing || (row_left && ended_leaves));
        stopped <= burst && !enable && (started || frames_inside != 2'd0);
        stopped_early <= frames_inside[1] && !recorded && (stopped_early || stopped);
        early <= recorded && stopped_early;
    end

    wire [31:0] signature;

    halfrow_signer signer (
        .clk(clk), .rst(rst || !burst), .anew(starts || (entered_start && !bursting)), .valid(given || entering),
        .last(signed_last), .sample(signed_sample), .next_frame(recorded), .signed_all(signed_all),
        .row_signature(row_signature), .signature(signature));

    wire [4:0] kept, freed, place;
    wire frees, record_write, head_write;
    wire [7:0] number_byte;

    wire carried_out, advance_ledger, trap_done, advance_trap;
    wire [3:0] ledger_refusal, trap_refusal;
    wire [2:0] ledger_detail;
    wire [15:0] trap_detail;

    assign request_done = carried_out || trap_done;
    assign advance = advance_ledger || advance_trap;
    assign refusal = ledger_refusal | trap_refusal;
    assign detail = {13'd0, ledger_detail} | trap_detail;

    halfrow_ledger #(.TABLE_BANKS(TABLE_BANKS), .TRAP(TRAP)) ledger (
        .clk(clk), .rst(rst), .start(request_start && !request_kind[1]), .of_records(request_kind[0]),
        .rewind(rewind), .advance(advance_ledger), .packet_byte(packet_byte), .finished(carried_out),
        .refusal(ledger_refusal), .detail(ledger_detail), .ready(ready),
        .busy(busy), .starts(starts), .seed(seed), .first_frame(first_frame), .frame_blanking(frame_blanking),
        .mode(mode), .under_way(burst), .drop(drop), .forget(forget), .named(named), .frame_begins(frame_begins),
        .more(more), .given(given), .paused(early || (stopped && !closing)), .row_left(row_left),
        .first_latency(first_latency), .last_latency(last_latency), .frame_left(ended_leaves), .signed_all(signed_all),
        .kept(kept), .frees(frees), .freed(freed), .record_write(record_write), .head_write(head_write),
        .record_place(place), .record_byte(number_byte), .recorded(recorded), .idle(ledger_idle));

    // The bytes of a record and of the reply's head that are no numbers of the ledger's.
    wire [1:0] state = burst ? UNDER_WAY : named ? ENDED : NO_BURST;
    wire [7:0] made_with = alternates && odd_leaves ? 8'd0 : generation;
    wire [7:0] of_head = place[0] ? {3'd0, kept} : {6'd0, state};
    wire [7:0] of_record = place[0] ? {7'd0, held_leaving} : made_with;
    wire of_signature = !head_write && place[4:2] == 3'd0;
    wire of_neither = head_write ? place[3] : place[4];
    wire [7:0] signature_byte = signature[{place[1:0], 3'd0} +: 8];
    wire [7:0] other_byte = head_write ? of_head : of_record;
    wire [7:0] reply_value;
    reg [4:0] told; // records in the reply, while further ones may be made

    halfrow_records #(.SLOT_BITS(bits_for(BURST_RECORDS))) records (
        .clk(clk), .rst(rst || starts || (drop && forget)), .frame_begins(frame_begins), .free(free), .drop(drop),
        .record_write(record_write), .head_write(head_write), .record_place(place),
        .record_byte(of_signature ? signature_byte : of_neither ? other_byte : number_byte), .recorded(recorded),
        .frees(frees), .freed(freed), .kept(kept), .reply_begins(reply_begins), .advance(reply_advance),
        .value(reply_value));

    wire [11:0] trap_length;
    wire [7:0] trap_value, trap_sample;
    reg [7:0] value_byte, sample_byte;
    wire [8:0] records_length = {told, 4'd0} + {3'd0, told, 1'b0} + HEAD_BYTES;

    assign reply_byte = value_byte | sample_byte;
    assign reply_length = request_kind[1] ? trap_length : {3'd0, records_length};
    assign quiet = ledger_idle && (!burst || (more && !free && frames_inside == 2'd0 && late));

    always @(posedge clk) begin
        value_byte <= (request_kind[1] ? trap_value : reply_value) & {8{replying}};
        sample_byte <= trap_sample & {8{replying && request_kind[1]}};
        if (head_write)
            told <= kept;
    end

    generate
        if (TRAP != 0) begin : with_trap
            halfrow_trap #(.MAX_HEIGHT(MAX_HEIGHT), .COLUMN_BITS(COLUMN_BITS)) trap (
                .clk(clk), .rst(rst), .ready(requests_ready),
                .expect_start(request_start && request_kind == KIND_EXPECT[1:0]), .first(expect_first),
                .count(expect_count), .packet_length(packet_length), .advance(advance_trap),
                .packet_byte(packet_byte), .trap_start(request_start && request_kind == KIND_TRAP[1:0]),
                .finished(trap_done), .refusal(trap_refusal), .detail(trap_detail), .reply_length(trap_length),
                .reply_begins(reply_begins), .reply_advance(reply_advance), .value(trap_value),
                .sample_value(trap_sample),
                .under_way(burst), .compares(mode == TRAPPED), .empty(drop || (starts && mode == TRAPPED)),
                .width(width), .height(height), .sample_bytes(sample_bytes), .given(given), .last(signed_last),
                .sample(signed_sample), .row_signature(row_signature), .frame_left(ended_leaves));
        end else begin : without_trap
            wire unused = &{1'b0, expect_first, expect_count, packet_length, width, height, sample_bytes};

            assign requests_ready = 1'b1;
            assign {trap_done, advance_trap, trap_refusal, trap_detail, trap_length, trap_value, trap_sample} = 50'd0;
        end
    endgenerate
endmodule

`default_nettype wire
