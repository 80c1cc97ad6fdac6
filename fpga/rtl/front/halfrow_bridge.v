// The whole board in one clock: bytes in, bytes out, the sensor in, the image processor out. Everything here is
// composition.
`default_nettype none

module halfrow_bridge #(
    parameter MAX_WIDTH = 2048,
    parameter MAX_HEIGHT = 2048,
    parameter POWER_UP_WIDTH = MAX_WIDTH, // what a sensor gives, which a session may change
    parameter POWER_UP_HEIGHT = MAX_HEIGHT,
    parameter RING_BITS = 11,             // M = 2 ** RING_BITS
    parameter TAPS = 7,                   // 5 or 7
    parameter TABLE_BANKS = 2,            // 1 or 2
    parameter ROW_BANKS_IN = 2,           // powers of two
    parameter ROW_BANKS_OUT = 2,
    parameter TRAP = 1,                   // there is one
    parameter GRID = 0,                   // 1: datapath 2 besides
    parameter ENTRIES = 2048,             // and then T, 2048 or 4096
    parameter [31:0] BUILD = 32'd0,       // the start of the commit
    parameter [7:0] NATURE = 8'd1,        // 1: hardware, 2: simulation
    parameter [8*69-1:0] NAME = "halfrow" // 1 to 68 bytes
) (
    input  wire        clk,
    input  wire        rst,

    input  wire        rx_valid,
    input  wire [7:0]  rx_data,
    output wire        rx_ready,
    output wire        tx_valid,
    output wire [7:0]  tx_data,
    input  wire        tx_ready,

    input  wire        millisecond,        // one clock each millisecond
    input  wire [7:0]  clock_source,       // 0: the host's, 1: PIXCLK, 2: a PLL
    input  wire [31:0] clock_hz,           // of clk, 0 when it is not known
    input  wire [63:0] serial,             // 0 for none

    input  wire        camera_frame_valid, // registered by the board
    input  wire        camera_line_valid,
    input  wire [11:0] camera_data,
    output wire        isp_frame_valid,    // W/2 + L clocks behind the sensor's
    output wire        isp_line_valid,
    output wire [11:0] isp_data,
    output wire        camera_fault,       // one clock: a row of the sensor was too short, too long or too early

    output wire        session_open,
    output wire        packet_seen,        // one clock: a packet has arrived whole
    output wire        quiet               // nothing happens until a byte comes in
);
    `include "halfrow_wire.vh"
    `include "halfrow_board.vh"

    generate // what a build cannot have
        if (ENTRIES != 2048 && ENTRIES != 4096) halfrow_illegal_ENTRIES is_2048_or_4096 ();
        if (RING_BITS < bits_for(MAX_WIDTH) || RING_BITS > 15) halfrow_illegal_RING_BITS holds_the_widest_row ();
    endgenerate

    localparam ROW_BITS = bits_for(MAX_HEIGHT > NODES ? MAX_HEIGHT : NODES);
    localparam ENTRY_BITS = GRID == 1 ? bits_for(ENTRIES) : ROW_BITS; // of a table's entry
    localparam COLUMN_BITS = bits_for(MAX_WIDTH);

    // The packet under way.
    wire packet_valid, packet_done, crc_error, framing_error;
    wire [7:0] packet_kind, packet_flags, packet_session, packet_byte;
    wire [15:0] packet_sequence, packet_length;
    wire [31:0] packet_window;
    wire [11:0] packet_address, request_address, row_address;
    wire row_busy;

    assign packet_address = row_busy ? row_address : request_address;

    halfrow_receiver receiver (
        .clk(clk), .rst(rst), .rx_valid(rx_valid), .rx_data(rx_data), .rx_ready(rx_ready),
        .packet_valid(packet_valid), .packet_kind(packet_kind), .packet_sequence(packet_sequence),
        .packet_length(packet_length), .packet_flags(packet_flags), .packet_session(packet_session),
        .packet_window(packet_window), .packet_done(packet_done), .packet_address(packet_address),
        .packet_byte(packet_byte), .crc_error(crc_error), .framing_error(framing_error));

    // Replies and rows on their way out.
    wire reply_valid, reply_flag, reply_taken, reply_byte_valid, reply_byte_ready;
    wire row_valid, row_flag, row_taken, row_byte_valid, row_byte_ready;
    wire [7:0] reply_kind, reply_session, reply_byte, row_kind, row_session, row_byte;
    wire [15:0] reply_sequence, reply_length, row_sequence, row_length;
    wire [31:0] credit_window;
    wire sender_idle;

    halfrow_sender sender (
        .clk(clk), .rst(rst),
        .reply_valid(reply_valid), .reply_kind(reply_kind), .reply_sequence(reply_sequence),
        .reply_length(reply_length), .reply_flag(reply_flag), .reply_session(reply_session),
        .reply_taken(reply_taken), .reply_byte_valid(reply_byte_valid), .reply_byte(reply_byte),
        .reply_byte_ready(reply_byte_ready),
        .row_valid(row_valid), .row_kind(row_kind), .row_sequence(row_sequence), .row_length(row_length),
        .row_flag(row_flag), .row_session(row_session), .row_taken(row_taken), .row_byte_valid(row_byte_valid),
        .row_byte(row_byte), .row_byte_ready(row_byte_ready),
        .window(credit_window), .tx_valid(tx_valid), .tx_data(tx_data), .tx_ready(tx_ready), .idle(sender_idle));

    // Settings, tables and the session, and what the rows tell them.
    wire hold, acknowledge, drop_rows, new_session, row_start, row_done, configured, idle;
    wire [31:0] acknowledge_window, drop_next_row, acknowledged, next_row_in, gap_seed;
    wire [3:0] row_refusal;
    wire [7:0] session, generation, shapes;
    wire [11:0] width, height;
    wire [12:0] centre2;
    wire [15:0] blanking, commit_frame, frame_number, first_latency, last_latency;
    wire [1:0] depth;
    wire active_bank, commit_pending, frame_start;
    wire rows_waiting, rows_held, core_busy, shadow_in_use, rows_quiet;
    wire burst_ready, burst_request, burst_rewind, burst_advance, burst_done, burst, silence;
    wire [1:0] burst_kind;
    wire [31:0] expect_span;
    wire [3:0] burst_refusal;
    wire [15:0] burst_detail;
    wire [11:0] answer_length;
    wire [7:0] answer_byte;
    wire answer_begin, answer_next, answering;
    wire row_accepted, row_left, row_repeated, row_unneeded, sample_over, latency_valid;

    wire step_write, node_write, table_bank, table_read;
    wire [ENTRY_BITS-1:0] table_entry;
    wire [79:0] table_data, node_port_0, node_port_1;
    wire [24:0] step_port;

    halfrow_dispatcher #(
        .MAX_WIDTH(MAX_WIDTH), .MAX_HEIGHT(MAX_HEIGHT),
        .POWER_UP_WIDTH(POWER_UP_WIDTH), .POWER_UP_HEIGHT(POWER_UP_HEIGHT),
        .GRID(GRID), .ENTRY_BITS(ENTRY_BITS), .RING_BITS(RING_BITS), .TAPS(TAPS),
        .LEAST_BLANKING(0), .TABLE_BANKS(TABLE_BANKS), .ROW_BANKS_IN(ROW_BANKS_IN),
        .ROW_BANKS_OUT(ROW_BANKS_OUT), .TRAP(TRAP), .BUILD(BUILD), .NATURE(NATURE), .NAME(NAME)
    ) dispatcher (
        .clk(clk), .rst(rst), .millisecond(millisecond), .clock_source(clock_source), .clock_hz(clock_hz),
        .serial(serial),
        .packet_valid(packet_valid), .packet_kind(packet_kind), .packet_sequence(packet_sequence),
        .packet_length(packet_length), .packet_session(packet_session), .packet_window(packet_window),
        .packet_done(packet_done), .packet_address(request_address), .packet_byte(packet_byte),
        .crc_error(crc_error), .framing_error(framing_error),
        .reply_valid(reply_valid), .reply_kind(reply_kind), .reply_sequence(reply_sequence),
        .reply_length(reply_length), .reply_flag(reply_flag), .reply_session(reply_session),
        .reply_taken(reply_taken), .reply_byte_valid(reply_byte_valid), .reply_byte(reply_byte),
        .reply_byte_ready(reply_byte_ready),
        .session_open(session_open), .session(session), .configured(configured), .width(width), .height(height),
        .centre2(centre2), .blanking(blanking), .gap_seed(gap_seed), .depth(depth),
        .row_start(row_start), .row_done(row_done), .row_refusal(row_refusal),
        .burst_ready(burst_ready), .burst_request(burst_request), .burst_kind(burst_kind),
        .expect_span(expect_span), .burst_rewind(burst_rewind),
        .burst_advance(burst_advance), .burst_done(burst_done), .burst_refusal(burst_refusal),
        .burst_detail(burst_detail), .answer_length(answer_length), .answer_begin(answer_begin),
        .answer_next(answer_next), .answering(answering), .answer_byte(answer_byte), .burst(burst),
        .silence(silence),
        .acknowledge(acknowledge), .acknowledge_window(acknowledge_window),
        .drop_rows(drop_rows), .drop_next_row(drop_next_row), .new_session(new_session), .hold(hold),
        .acknowledged(acknowledged), .next_row_in(next_row_in), .rows_waiting(rows_waiting), .rows_held(rows_held),
        .core_busy(core_busy), .shadow_in_use(shadow_in_use),
        .frame_start(frame_start), .frame_number(frame_number), .generation(generation), .active_bank(active_bank),
        .shapes(shapes), .commit_pending(commit_pending), .commit_frame(commit_frame),
        .row_accepted(row_accepted), .row_left(row_left), .row_repeated(row_repeated), .row_unneeded(row_unneeded),
        .sample_over(sample_over), .latency_valid(latency_valid), .first_latency(first_latency),
        .last_latency(last_latency),
        .step_write(step_write), .node_write(node_write), .table_bank(table_bank), .table_entry(table_entry),
        .table_data(table_data), .table_read(table_read), .step_port(step_port), .node_port_0(node_port_0),
        .node_port_1(node_port_1), .idle(idle));

    // Test rows.
    wire core_valid, core_start;
    wire [11:0] core_sample;
    wire test_reset, test_enables, test_prepare, test_prepare_bank, test_valid, test_start, test_out_valid;
    wire [ROW_BITS-1:0] test_prepare_row;
    wire [11:0] test_sample;
    wire prepared, out_valid, out_start, out_last, core_enable, burst_frame;
    wire [11:0] out_sample;

    halfrow_rows #(
        .MAX_HEIGHT(MAX_HEIGHT), .ROW_BITS(ROW_BITS), .COLUMN_BITS(COLUMN_BITS), .TAPS(TAPS), .TABLE_BANKS(TABLE_BANKS),
        .ROW_BANKS_IN(ROW_BANKS_IN), .ROW_BANKS_OUT(ROW_BANKS_OUT), .TRAP(TRAP)
    ) rows (
        .clk(clk), .rst(rst), .row_start(row_start), .row_done(row_done), .row_refusal(row_refusal),
        .row_busy(row_busy), .packet_address(row_address), .packet_byte(packet_byte), .packet_length(packet_length),
        .burst_ready(burst_ready), .burst_request(burst_request), .burst_kind(burst_kind),
        .expect_span(expect_span), .burst_rewind(burst_rewind),
        .burst_advance(burst_advance), .burst_done(burst_done), .burst_refusal(burst_refusal),
        .burst_detail(burst_detail), .answer_length(answer_length), .answer_begin(answer_begin),
        .answer_next(answer_next), .answering(answering), .answer_byte(answer_byte), .burst(burst),
        .silence(silence),
        .hold(hold), .acknowledge(acknowledge), .acknowledge_window(acknowledge_window),
        .drop_rows(drop_rows), .drop_next_row(drop_next_row), .new_session(new_session), .session(session),
        .width(width), .height(height), .blanking(blanking), .gap_seed(gap_seed), .depth(depth),
        .configured(configured), .generation(generation), .active_bank(active_bank), .commit_pending(commit_pending),
        .commit_frame(commit_frame), .frame_start(frame_start), .frame_number(frame_number),
        .credit_window(credit_window), .acknowledged(acknowledged), .next_row_in(next_row_in),
        .rows_waiting(rows_waiting), .rows_held(rows_held), .core_busy(core_busy), .shadow_in_use(shadow_in_use),
        .quiet(rows_quiet),
        .row_accepted(row_accepted), .row_left(row_left), .row_repeated(row_repeated), .row_unneeded(row_unneeded),
        .sample_over(sample_over), .latency_valid(latency_valid), .first_latency(first_latency),
        .last_latency(last_latency),
        .row_valid(row_valid), .row_kind(row_kind), .row_sequence(row_sequence), .row_length(row_length),
        .row_flag(row_flag), .row_session(row_session), .row_taken(row_taken), .row_byte_valid(row_byte_valid),
        .row_byte(row_byte), .row_byte_ready(row_byte_ready),
        .core_reset(test_reset), .prepare(test_prepare), .prepare_row(test_prepare_row),
        .prepare_bank(test_prepare_bank), .prepared(prepared), .enables(test_enables), .in_valid(test_valid),
        .in_start(test_start), .in_sample(test_sample), .out_valid(test_out_valid), .out_start(out_start),
        .out_last(out_last), .out_sample(out_sample), .core_enable(core_enable), .core_valid(core_valid),
        .core_start(core_start), .core_sample(core_sample), .frame_valid(burst_frame),
        .pin_valid(isp_line_valid), .pin_sample(isp_data));

    // The sensor's rows.
    wire camera_reset, camera_prepare, camera_prepare_bank, camera_valid, camera_start, output_reset, shown_valid;
    wire camera_frame, row_missed;
    wire [ROW_BITS-1:0] camera_prepare_row;
    wire [11:0] camera_sample;

    halfrow_camera_input #(.ROW_BITS(ROW_BITS)) camera_input (
        .clk(clk), .rst(camera_reset), .height(height), .bank(active_bank),
        .camera_frame_valid(camera_frame_valid), .camera_line_valid(camera_line_valid), .camera_data(camera_data),
        .prepare(camera_prepare), .prepare_row(camera_prepare_row), .prepare_bank(camera_prepare_bank),
        .prepared(prepared), .in_valid(camera_valid), .in_start(camera_start), .in_sample(camera_sample),
        .frame_valid(camera_frame), .row_missed(row_missed));

    halfrow_camera_output #(.TAPS(TAPS)) camera_output (
        .clk(clk), .rst(output_reset), .width(width), .frame_valid(camera_frame || burst_frame),
        .out_valid(shown_valid), .out_sample(out_sample), .isp_frame_valid(isp_frame_valid),
        .isp_line_valid(isp_line_valid), .isp_data(isp_data));

    // Both through one core.
    wire core_reset, prepare, prepare_bank;
    wire row_short, row_long, row_unprepared;
    wire [ROW_BITS-1:0] prepare_row;
    wire [10:0] last_row = height[10:0] - 11'd1;
    wire [3:0] prepare_shape = prepare_bank ? shapes[7:4] : shapes[3:0];

    halfrow_multiplexer #(.ROW_BITS(ROW_BITS)) multiplexer (
        .clk(clk), .rst(rst), .session_open(session_open), .tables_ready(idle), .burst(burst),
        .camera_reset(camera_reset), .output_reset(output_reset),
        .test_reset(test_reset), .test_enables(test_enables), .test_prepare(test_prepare),
        .test_prepare_row(test_prepare_row), .test_prepare_bank(test_prepare_bank), .test_valid(test_valid),
        .test_start(test_start), .test_sample(test_sample), .test_out_valid(test_out_valid),
        .camera_prepare(camera_prepare), .camera_prepare_row(camera_prepare_row),
        .camera_prepare_bank(camera_prepare_bank), .camera_valid(camera_valid), .camera_start(camera_start),
        .camera_sample(camera_sample), .shown_valid(shown_valid),
        .core_reset(core_reset), .core_enable(core_enable), .prepare(prepare), .prepare_row(prepare_row),
        .prepare_bank(prepare_bank), .in_valid(core_valid), .in_start(core_start),
        .in_sample(core_sample), .out_valid(out_valid));

    halfrow_core #(
        .MAX_HEIGHT(MAX_HEIGHT), .ROW_BITS(ROW_BITS), .GRID(GRID), .ENTRY_BITS(ENTRY_BITS), .RING_BITS(RING_BITS),
        .TAPS(TAPS), .TABLE_BANKS(TABLE_BANKS)
    ) core (
        .clk(clk), .rst(core_reset), .enable(core_enable), .width(width), .last_row(last_row), .centre2(centre2),
        .depth(depth), .prepare(prepare), .prepare_row(prepare_row), .prepare_bank(prepare_bank),
        .prepare_shape(prepare_shape), .prepared(prepared),
        .in_valid(core_valid), .in_start(core_start), .in_sample(core_sample),
        .out_valid(out_valid), .out_start(out_start), .out_last(out_last), .out_sample(out_sample),
        .row_short(row_short), .row_long(row_long), .row_unprepared(row_unprepared),
        .step_write(step_write), .node_write(node_write), .table_bank(table_bank), .table_entry(table_entry),
        .table_data(table_data), .table_read(table_read), .step_port(step_port), .node_port_0(node_port_0),
        .node_port_1(node_port_1));

    wire unused = &{1'b0, packet_flags}; // kinds tell replies from requests

    assign camera_fault = !session_open && (row_short || row_long || row_unprepared || row_missed);

    reg held;

    always @(posedge clk)
        held <= packet_valid && !rst;

    assign packet_seen = packet_valid && !held;
    assign quiet = rx_ready && !rx_valid && !packet_valid && idle && rows_quiet && sender_idle && !tx_valid;
endmodule

`default_nettype wire
