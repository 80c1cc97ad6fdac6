// Carries out the host's packets, one after the other: session, kind, payload, then the request itself, and a reply
// or a refusal. Rows are handed to the row path.
`default_nettype none

module halfrow_dispatcher #(
    parameter MAX_WIDTH = 2048,
    parameter MAX_HEIGHT = 2048,
    parameter POWER_UP_WIDTH = MAX_WIDTH, // what a sensor gives, which a session may change
    parameter POWER_UP_HEIGHT = MAX_HEIGHT,
    parameter GRID = 0,                   // datapath 2 besides
    parameter ENTRY_BITS = 11,            // at least 7; with a grid 11 or 12: T = 2 ** ENTRY_BITS
    parameter RING_BITS = 11,             // M = 2 ** RING_BITS
    parameter TAPS = 7,                   // 5 or 7
    parameter LEAST_BLANKING = 0,
    parameter TABLE_BANKS = 2,            // 1 or 2
    parameter ROW_BANKS_IN = 2,
    parameter ROW_BANKS_OUT = 2,
    parameter TRAP = 1,                   // there is one
    parameter [31:0] BUILD = 32'd0,       // the start of the commit
    parameter [7:0] NATURE = 8'd1,        // 1: hardware, 2: simulation
    parameter [8*69-1:0] NAME = "halfrow" // 1 to 68 bytes
) (
    input  wire                  clk,
    input  wire                  rst,
    input  wire                  millisecond,   // pulse, once a millisecond
    input  wire [7:0]            clock_source,  // 0: the host's, 1: PIXCLK, 2: a PLL
    input  wire [31:0]           clock_hz,      // 0 when it is not known
    input  wire [63:0]           serial,        // 0 for none

    input  wire                  packet_valid,
    input  wire [7:0]            packet_kind,
    input  wire [15:0]           packet_sequence,
    input  wire [15:0]           packet_length,
    input  wire [7:0]            packet_session,
    input  wire [31:0]           packet_window,
    output wire                  packet_done,
    output reg  [11:0]           packet_address,
    input  wire [7:0]            packet_byte,   // one clock behind its address
    input  wire                  crc_error,
    input  wire                  framing_error,

    output wire                  reply_valid,
    output wire [7:0]            reply_kind,
    output wire [15:0]           reply_sequence,
    output wire [15:0]           reply_length,
    output wire                  reply_flag,
    output wire [7:0]            reply_session,
    input  wire                  reply_taken,
    output wire                  reply_byte_valid,
    output wire [7:0]            reply_byte,
    input  wire                  reply_byte_ready,

    output wire                  session_open,
    output wire [7:0]            session,       // 0 for none
    output wire                  configured,
    output wire [11:0]           width,
    output wire [11:0]           height,
    output wire [12:0]           centre2,
    output wire [15:0]           blanking,
    output wire [31:0]           gap_seed,
    output wire [1:0]            depth,         // 0: 8 bits, 1: 10, 2: 12

    output wire                  row_start,     // pulse: a ROW_IN packet lies in the receiver's buffer
    input  wire                  row_done,      // pulse: it was dealt with
    input  wire [3:0]            row_refusal,   // with row_done: a refusal's code, or 0

    input  wire                  burst_ready,   // high once requests of bursts may come
    output wire                  burst_request, // pulse: a BURST, RECORDS, EXPECT or TRAP lies in the receiver's buffer
    output wire [1:0]            burst_kind,    // which it is, numbered so
    output wire [31:0]           expect_span,   // of an EXPECT, whose first signature is read: first row, their count
    input  wire                  burst_rewind,  // pulse: its payload is read from the first byte on
    input  wire                  burst_advance, // by one byte
    input  wire                  burst_done,    // pulse: it was dealt with
    input  wire [3:0]            burst_refusal, // with burst_done: a refusal's code, or 0
    input  wire [15:0]           burst_detail,
    input  wire [11:0]           answer_length, // bytes of the reply to RECORDS or TRAP
    output wire                  answer_begin,  // pulse: its first byte is wanted
    output wire                  answer_next,   // the next one is
    output wire                  answering,     // it is under way
    input  wire [7:0]            answer_byte,   // two clocks later, 0 unless it is
    input  wire                  burst,         // one is under way
    output wire                  silence,       // pulse: and the host has been silent for too long

    output reg                   acknowledge,   // pulse, before the packet is carried out
    output wire [31:0]           acknowledge_window,
    output reg                   drop_rows,     // pulse: drop all rows and wait for drop_next_row
    output wire [31:0]           drop_next_row,
    output wire                  new_session,   // with drop_rows
    output wire                  hold,          // no further row starts: a request is carried out
    input  wire [31:0]           acknowledged,
    input  wire [31:0]           next_row_in,
    input  wire                  rows_waiting,
    input  wire                  rows_held,
    input  wire                  core_busy,
    input  wire                  shadow_in_use, // by a row inside the core; with one bank, any row inside

    input  wire                  frame_start,   // pulse: row 0 of frame_number is about to be prepared
    input  wire [15:0]           frame_number,
    output wire [7:0]            generation,    // active; 0 for none
    output wire                  active_bank,
    output wire [7:0]            shapes,        // {k is 6, v} of bank 1 and of bank 0
    output wire                  commit_pending,
    output wire [15:0]           commit_frame,

    input  wire                  row_accepted,  // pulses to be counted
    input  wire                  row_left,
    input  wire                  row_repeated,
    input  wire                  row_unneeded,
    input  wire                  sample_over,
    input  wire                  latency_valid,
    input  wire [15:0]           first_latency,
    input  wire [15:0]           last_latency,

    output wire                  step_write,
    output wire                  node_write,
    output wire                  table_bank,
    output wire [ENTRY_BITS-1:0] table_entry,
    output wire [79:0]           table_data,
    output wire                  table_read,
    input  wire [24:0]           step_port,     // three clocks behind table_entry
    input  wire [79:0]           node_port_0,
    input  wire [79:0]           node_port_1,

    output wire                  idle           // no packet is under way, and everything is counted
);
    `include "halfrow_wire.vh"
    `include "halfrow_board.vh"

    generate // what a build cannot have
        if (ENTRY_BITS < bits_for(MAX_HEIGHT) || ENTRY_BITS < (GRID == 1 ? 11 : bits_for(NODES)) || ENTRY_BITS > 12)
            halfrow_illegal_ENTRY_BITS numbers_rows_and_nodes_or_entries_of_a_grid ();
    endgenerate

    localparam IDLE = 4'd0, LOAD = 4'd1, JUDGE = 4'd2, TABLES = 4'd3, COUNTED = 4'd4, SETTLE = 4'd5, ROW = 4'd6,
               ROW_WAIT = 4'd7, REFUSE = 4'd8, REPLY = 4'd9, SEND = 4'd10, DONE = 4'd11, BURST = 4'd12;

    reg [3:0] state;
    reg [103:0] fields; // the payload's first 13 bytes, the first in [7:0]
    reg refused;
    reg [3:0] code;
    reg [15:0] detail;
    wire [7:0] level = fields[7:0];

    wire is_hello = packet_kind == KIND_HELLO;
    wire is_reset = packet_kind == KIND_RESET;
    wire is_status = packet_kind == KIND_STATUS;
    wire is_configure = packet_kind == KIND_CONFIGURE;
    wire of_session = session_open && packet_session == session;
    wire status_idle, tables_ready, silent;
    wire begins = state == IDLE && packet_valid && tables_ready && burst_ready && !(burst && silent);

    assign packet_done = state == DONE;
    assign hold = state != IDLE && packet_kind != KIND_ROW_IN;
    assign idle = state == IDLE && !packet_valid && tables_ready && burst_ready && status_idle;
    assign row_start = state == ROW;
    assign acknowledge_window = packet_window;
    always @(posedge clk) acknowledge <= begins && !is_hello && of_session;

    // The payload's start, and what it must have.
    wire settled = &packet_address[3:0];
    wire unknown, malformed, has_shape;
    wire [12:0] read_length;

    always @(posedge clk)
        if (state == LOAD && packet_address[3:0] != 4'd0 && packet_address[3:1] != 3'd7)
            fields <= {packet_byte, fields[103:8]};

    halfrow_request #(.TRAP(TRAP), .GRID(GRID)) request (
        .clk(clk), .kind(packet_kind), .length(packet_length), .fields(fields[55:0]), .unknown(unknown),
        .malformed(malformed), .has_shape(has_shape), .read_length(read_length));
    reg judging; // the state is JUDGE
    wire accepted = judging && !unknown && !malformed;
    always @(posedge clk) judging <= !rst && state == LOAD && settled;

    // HELLO
    wire repeated, held;
    wire [6:0] tenths_left;
    reg common_version; // of a HELLO; the fields stand still for a clock before they are judged
    reg take_over;
    wire welcome = common_version && (!held || take_over);
    wire greeted = accepted && is_hello;
    wire opens = accepted && welcome && !repeated;

    wire closes = state == DONE && is_reset && !refused && level == RESET_CLOSES;

    always @(posedge clk) begin
        common_version <= is_hello && fields[71:65] == 7'd0 && fields[79:72] != 8'd0;
        take_over <= fields[87:80] != 8'd0;
    end

    halfrow_session session_rules (
        .clk(clk), .rst(rst), .millisecond(millisecond), .nonce(fields[31:0]), .host(fields[63:32]),
        .heard(acknowledge), .greet(greeted), .open(opens), .close(closes), .repeated(repeated), .held(held),
        .tenths_left(tenths_left), .burst(burst), .at_rest(state == IDLE), .silent(silent), .silence(silence),
        .session_open(session_open), .session(session));

    // RESET
    wire resets = accepted && is_reset;
    wire wipe = resets && level == RESET_WIPES;
    always @(posedge clk) drop_rows <= (opens || resets) && !rst;
    assign new_session = is_hello;
    assign drop_next_row = fields[39:8] & {32{!new_session}}; // a session's first row is row 0

    // CONFIGURE
    wire out_of_range;
    wire [2:0] wrong_field;
    wire rows_anywhere = rows_waiting || rows_held || core_busy;

    halfrow_settings #(
        .MAX_WIDTH(MAX_WIDTH), .MAX_HEIGHT(MAX_HEIGHT), .LEAST_BLANKING(LEAST_BLANKING),
        .POWER_UP_WIDTH(POWER_UP_WIDTH), .POWER_UP_HEIGHT(POWER_UP_HEIGHT)
    ) settings (
        .clk(clk), .restore(rst || wipe), .wanted(fields),
        .load(accepted && is_configure && !rows_anywhere && !out_of_range), .out_of_range(out_of_range),
        .wrong_field(wrong_field), .configured(configured), .width(width), .height(height), .centre2(centre2),
        .blanking(blanking), .gap_seed(gap_seed), .depth(depth));

    // Tables
    wire of_tables = packet_kind[7:2] == KIND_TABLE_READ[7:2];
    wire tables_finished, rewind, advance_table, table_byte_valid, table_byte_ready;
    wire [3:0] table_refusal;
    wire [15:0] table_detail;
    wire [7:0] table_byte;
    wire [31:0] crc;

    halfrow_tables #(
        .MAX_HEIGHT(MAX_HEIGHT), .GRID(GRID), .ENTRY_BITS(ENTRY_BITS), .TAPS(TAPS), .TABLE_BANKS(TABLE_BANKS)
    ) tables (
        .clk(clk), .rst(rst), .wipe(wipe), .ready(tables_ready), .start(accepted && of_tables),
        .request(packet_kind[1:0]), .fields(fields), .has_shape(has_shape), .finished(tables_finished),
        .refusal(table_refusal), .detail(table_detail),
        .send(reply_taken && packet_kind == KIND_TABLE_READ && !refused), .crc(crc), .rewind(rewind),
        .advance(advance_table), .packet_byte(packet_byte), .byte_valid(table_byte_valid), .byte_read(table_byte),
        .byte_ready(table_byte_ready), .configured(configured), .width(width), .height(height), .core_busy(core_busy),
        .shadow_in_use(shadow_in_use), .forget(drop_rows), .frame_start(frame_start), .frame_number(frame_number),
        .generation(generation), .active_bank(active_bank), .shapes(shapes), .commit_pending(commit_pending),
        .commit_frame(commit_frame), .step_write(step_write), .node_write(node_write), .table_bank(table_bank),
        .table_entry(table_entry), .table_data(table_data), .table_read(table_read), .step_port(step_port),
        .node_port_0(node_port_0), .node_port_1(node_port_1));

    // Bursts
    reg of_bursts;
    wire advance_reply;
    assign burst_request = accepted && of_bursts;
    assign burst_kind = packet_kind[1:0];
    assign expect_span = fields[31:0];
    assign answering = of_bursts && burst_kind[0] && !refused;
    assign answer_begin = reply_taken && answering;
    assign answer_next = advance_reply;

    always @(posedge clk) of_bursts <= packet_kind[7:2] == KIND_BURST[7:2];

    // Counters
    wire [7:0] status_byte;
    reg report;
    always @(posedge clk)
        if (rst || state == DONE) report <= 1'b0;
        else if (state == COUNTED && status_idle) report <= 1'b1;

    halfrow_status status (
        .clk(clk), .rst(rst), .clear(opens), .idle(status_idle), .packet(begins), .crc_error(crc_error),
        .framing_error(framing_error), .foreign_packet(begins && !is_hello && !of_session), .refusal(state == REFUSE),
        .row_accepted(row_accepted), .row_left(row_left), .row_repeated(row_repeated), .row_unneeded(row_unneeded),
        .sample_over(sample_over), .latency_valid(latency_valid), .first_latency(first_latency),
        .last_latency(last_latency), .next_row_in(next_row_in), .acknowledged(acknowledged), .core_busy(core_busy),
        .generation(generation), .report(report), .report_clears(level != 8'd0), .index(packet_address[5:0]),
        .take(advance_reply), .value(status_byte));

    wire [7:0] capabilities_byte, capabilities_length;
    halfrow_capabilities #(
        .MAX_WIDTH(MAX_WIDTH), .MAX_HEIGHT(MAX_HEIGHT), .TAPS(TAPS), .RING_BITS(RING_BITS),
        .LEAST_BLANKING(LEAST_BLANKING), .TABLE_BANKS(TABLE_BANKS), .ROW_BANKS_IN(ROW_BANKS_IN),
        .ROW_BANKS_OUT(ROW_BANKS_OUT), .TRAP(TRAP), .GRID(GRID), .ENTRY_BITS(ENTRY_BITS), .NATURE(NATURE), .NAME(NAME)
    ) capabilities (
        .clock_source(clock_source), .clock_hz(clock_hz), .index(packet_address[7:0]), .value(capabilities_byte),
        .length(capabilities_length));

    // The reply
    reg [2:0] source;
    reg [12:0] length;
    wire sent;

    always @(posedge clk) begin
        source <= FROM_PACKET;
        length <= 13'd0;
        if (refused) begin
            source <= FROM_REFUSAL;
            length <= 13'd4;
        end else
            case (packet_kind)
                KIND_HELLO: {source, length} <= {FROM_HELLO, 13'd22};
                KIND_CAPABILITIES: {source, length} <= {FROM_CAPABILITIES, 5'd0, capabilities_length};
                KIND_STATUS: {source, length} <= {FROM_STATUS, 13'd64};
                KIND_ECHO: length <= packet_length[12:0];
                KIND_TABLE_READ: {source, length} <= {FROM_TABLE, read_length};
                KIND_TABLE_CRC: {source, length} <= {FROM_CRC, 13'd4};
                KIND_COMMIT: {source, length} <= {FROM_COMMIT, 13'd1};
                KIND_RECORDS, KIND_TRAP: {source, length} <= {FROM_STATUS, 1'b0, answer_length};
                default: ;
            endcase
    end

    assign reply_kind = refused ? KIND_REFUSAL : packet_kind;
    assign reply_sequence = packet_sequence;
    assign reply_length = {4'd0, length[11:0]};
    assign reply_flag = 1'b1;
    assign reply_session = refused ? packet_session : session;

    halfrow_reply #(.BUILD(BUILD)) reply (
        .clk(clk), .rst(rst), .begin_payload(reply_taken), .length(length[11:0]), .done(sent), .source(source),
        .index(packet_address), .advance(advance_reply), .packet_byte(packet_byte), .session(session), .serial(serial),
        .capabilities_byte(capabilities_byte), .status_byte(status_byte | answer_byte), .crc(~crc),
        .generation(fields[87:80]), .refusal({detail, packet_kind, 4'd0, code}), .table_byte_valid(table_byte_valid),
        .table_byte(table_byte), .table_byte_ready(table_byte_ready), .byte_valid(reply_byte_valid),
        .byte_data(reply_byte), .byte_ready(reply_byte_ready));

    // One counter reads the payload's start, what stands behind it, and an ECHO, and counts the bytes of a reply.
    always @(posedge clk) begin
        if (judging && of_bursts && burst_kind == KIND_EXPECT[1:0]) packet_address <= 12'd4;
        else if (state == IDLE || state == JUDGE || reply_taken || burst_rewind) packet_address <= 12'd0;
        else if (rewind) packet_address <= 12'd7;
        else if (state == LOAD || state == SETTLE || advance_table || advance_reply || burst_advance)
            packet_address <= packet_address + 12'd1;
    end

    reg reply_ready; // source and length are those of this reply
    always @(posedge clk) reply_ready <= state == REPLY;
    assign reply_valid = state == REPLY && reply_ready;

    always @(posedge clk) begin
        case (state)
            IDLE: begin
                refused <= 1'b0;
                detail <= 16'd0;
                code <= REFUSAL_SESSION;
                if (begins)
                    case (packet_kind)
                        KIND_HELLO: state <= LOAD;
                        KIND_ROW_ACK: state <= DONE;
                        KIND_ROW_IN: state <= of_session ? ROW : REFUSE;
                        default: state <= of_session ? LOAD : REFUSE;
                    endcase
            end
            LOAD: if (settled) state <= JUDGE;
            JUDGE: begin
                state <= REPLY;
                if (unknown) begin
                    code <= REFUSAL_KIND;
                    state <= REFUSE;
                end else if (malformed) begin
                    code <= REFUSAL_PAYLOAD;
                    state <= REFUSE;
                end else if (is_hello) begin
                    if (!common_version) {code, detail} <= {REFUSAL_VERSION, 8'd0, WIRE_VERSION};
                    else {code, detail} <= {REFUSAL_HELD, 9'd0, tenths_left};
                    state <= welcome ? SETTLE : REFUSE;
                end else if (is_reset) state <= SETTLE;
                else if (is_status) state <= COUNTED;
                else if (is_configure) begin
                    if (rows_anywhere) code <= REFUSAL_BUSY;
                    else {code, detail} <= {REFUSAL_RANGE, 13'd0, wrong_field};
                    if (rows_anywhere || out_of_range) state <= REFUSE;
                end else if (of_tables) state <= TABLES;
                else if (of_bursts) state <= BURST;
            end
            TABLES:
            begin
                {code, detail} <= {table_refusal, table_detail};
                if (tables_finished) state <= table_refusal != 4'd0 ? REFUSE : REPLY;
            end
            BURST:
            if (burst_done) begin
                code <= burst_refusal;
                detail <= burst_detail;
                state <= burst_refusal != 4'd0 ? REFUSE : REPLY;
            end
            COUNTED: if (status_idle) state <= REPLY;
            SETTLE: if (settled && status_idle && tables_ready) state <= REPLY;
            ROW: state <= ROW_WAIT;
            ROW_WAIT:
            if (row_done) begin
                code <= row_refusal;
                state <= row_refusal != 4'd0 ? REFUSE : DONE;
            end
            REFUSE: begin
                refused <= 1'b1;
                state <= REPLY;
            end
            REPLY: if (reply_taken) state <= SEND;
            SEND: if (sent) state <= DONE;
            default: state <= IDLE;
        endcase
        if (rst) state <= IDLE;
    end

    wire unused = &{1'b0, length[12]};
endmodule

`default_nettype wire
