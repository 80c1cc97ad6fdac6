// A dispatcher between a receiver, a sender, a core and a row path that do as a bench says. Included in the bench's module,
// behind its localparams MAX_WIDTH, MAX_HEIGHT, GRID, ENTRY_BITS, TAPS, LEAST_BLANKING, TABLE_BANKS, ROW_BANKS_IN, ROW_BANKS_OUT.
localparam HELLO = 8'h00, CAPABILITIES = 8'h01, STATUS = 8'h02, RESET = 8'h03, ECHO = 8'h04, TABLE_WRITE = 8'h10,
           TABLE_READ = 8'h11, TABLE_CRC = 8'h12, COMMIT = 8'h13, CONFIGURE = 8'h18, ROW_IN = 8'h20, ROW_ACK = 8'h22,
           BURST = 8'h30, RECORDS = 8'h31, EXPECT = 8'h32, TRAP = 8'h33;
localparam NONE = 0, VERSION_WRONG = 1, KIND_UNKNOWN = 2, PAYLOAD = 3, RANGE = 4, SESSION = 5, HELD = 6, BUSY = 7,
           NOT_READY = 8, TABLE_CRC_WRONG = 9, CREDIT = 10, OUTER_TAPS = 12;
localparam STEPS = 0, KERNEL = 1, SHADOW = 0, ACTIVE = 1;
localparam [7:0] NO_KIND = 8'hee; // of a request that got no reply; no reply has it

reg clk, rst, millisecond;
initial clk = 0;
always #5 clk = ~clk;

// The receiver
reg         packet_valid;
reg  [ 7:0] packet_kind, packet_session, packet_byte;
reg  [15:0] packet_sequence, packet_length;
reg  [31:0] packet_window;
wire        packet_done;
wire [11:0] packet_address;
reg  [ 7:0] payload [0:4095];
reg         crc_error, framing_error;

always @(posedge clk) packet_byte <= packet_valid && packet_address < packet_length ? payload[packet_address] : 8'hxx;

// The sender
wire        reply_valid, reply_flag, reply_byte_valid;
wire [ 7:0] reply_kind, reply_session, reply_byte;
wire [15:0] reply_sequence, reply_length;
reg         reply_taken, reply_byte_ready;
reg  [ 7:0] got [0:4095];
integer     got_total, replies;
reg  [ 7:0] got_kind, got_session;
reg  [15:0] got_sequence, got_length;

// The row path
wire        session_open, configured, row_start, acknowledge, drop_rows, new_session, hold;
wire [ 7:0] session, generation;
wire [11:0] width, height;
wire [12:0] centre2;
wire [15:0] blanking, commit_frame;
wire [31:0] gap_seed, acknowledge_window, drop_next_row;
wire [ 1:0] depth;
reg         row_done;
reg  [ 3:0] row_refusal, row_answer;
reg  [31:0] acknowledged, next_row_in;
reg         rows_waiting, rows_held, core_busy, shadow_in_use, frame_start;
reg  [15:0] frame_number;
wire        active_bank, commit_pending;
reg         row_accepted, row_left, row_repeated, row_unneeded, sample_over, latency_valid;
reg  [15:0] first_latency, last_latency;
integer     acknowledges, row_starts, drops, new_sessions, held_clocks;
reg  [31:0] last_acknowledge, last_drop;

// The bursts, which read a packet's first bytes twice before they are done with it, of an EXPECT the first time from the
// first signature on.
wire        burst_request, answer_begin, answer_next, answering, silent;
reg         burst, burst_done, burst_rewind, burst_advance;
reg  [ 3:0] burst_refusal;
wire [ 1:0] burst_kind;
wire [31:0] expect_span;
reg  [15:0] burst_detail;
reg  [ 7:0] record_index, record_first, record_second;
integer     silences, burst_requests, read_place, read_from;

always @(posedge clk) begin
    record_index  <= answer_begin ? 8'd0 : record_index + {7'd0, answer_next};
    record_first  <= record_index ^ 8'h5a;
    record_second <= answering ? record_first : 8'd0;
    if (silent) silences = silences + 1;
end

always @(posedge clk)
    if (burst_request) begin
        burst_requests = burst_requests + 1;
        check({6'h0c, burst_kind} === packet_kind, "a request of bursts is taken for another");
        check(expect_span[15:0] === {payload[1], payload[0]} || packet_kind !== EXPECT, "the first row expected");
        check(expect_span[31:16] === {payload[3], payload[2]} || packet_kind !== EXPECT, "how many rows are expected");
        read_from = packet_kind === EXPECT ? 4 : 0;
        repeat (2) begin
            for (read_place = read_from; read_place < read_from + 3; read_place = read_place + 1) begin
                @(negedge clk);
                check(packet_address === read_place, "the place in a request of bursts");
                @(negedge clk);
                check(packet_byte === payload[read_place] || read_place >= packet_length, "a byte of a request of bursts");
                burst_advance = 1;
                @(negedge clk) burst_advance = 0;
            end
            burst_rewind = 1;
            @(negedge clk) burst_rewind = 0;
            read_from = 0;
        end
        burst_done = 1;
        @(negedge clk) burst_done = 0;
    end

// The core
wire                   step_write, node_write, table_bank, table_read;
wire [ENTRY_BITS-1:0]  table_entry;
wire [         7:0]    shapes;
wire [        79:0]    table_data;
reg  [        24:0]    step_port;
reg  [        79:0]    node_port_0, node_port_1;
reg  [        24:0]    steps   [0:8191];   // {bank, entry}
reg  [        79:0]    nodes_0 [0:255];
reg  [        79:0]    nodes_1 [0:255];
reg  [        12:0]    address_1, address_2;
reg                    read_1, read_2;
integer                writes;
wire                   idle;

always @(posedge clk) begin
    if (step_write) steps[{table_bank, 12'd0} | table_entry] <= table_data[24:0];
    if (node_write) begin
        nodes_0[{table_bank, table_entry[6:0]}] <= table_data;
        nodes_1[{table_bank, table_entry[6:0]}] <= table_data;
    end
    if (step_write || node_write) writes = writes + 1;
    address_1   <= {table_bank, 12'd0} | table_entry;
    read_1      <= table_read;
    step_port   <= table_read && read_1 ? steps[address_1] : 25'hx;
    node_port_0 <= table_read && read_1 ? nodes_0[{address_1[12], address_1[6:0]}] : 80'hx;
    node_port_1 <= table_read && read_1 ? nodes_1[{address_1[12], address_1[6:0]}] : 80'hx;
end

halfrow_dispatcher #(
    .MAX_WIDTH(MAX_WIDTH), .MAX_HEIGHT(MAX_HEIGHT), .GRID(GRID), .ENTRY_BITS(ENTRY_BITS), .TAPS(TAPS),
    .LEAST_BLANKING(LEAST_BLANKING), .TABLE_BANKS(TABLE_BANKS), .ROW_BANKS_IN(ROW_BANKS_IN), .ROW_BANKS_OUT(ROW_BANKS_OUT),
    .BUILD(32'h9f3c1e07), .NAME({"straightener ", 24'he28496, " 7"})
) dut (
    .clk(clk), .rst(rst), .millisecond(millisecond), .clock_source(8'd2), .clock_hz(32'd74250000),
    .serial(64'h0123456789abcdef), .packet_valid(packet_valid), .packet_kind(packet_kind),
    .packet_sequence(packet_sequence), .packet_length(packet_length), .packet_session(packet_session),
    .packet_window(packet_window), .packet_done(packet_done), .packet_address(packet_address), .packet_byte(packet_byte),
    .crc_error(crc_error), .framing_error(framing_error), .reply_valid(reply_valid), .reply_kind(reply_kind),
    .reply_sequence(reply_sequence), .reply_length(reply_length), .reply_flag(reply_flag), .reply_session(reply_session),
    .reply_taken(reply_taken), .reply_byte_valid(reply_byte_valid), .reply_byte(reply_byte),
    .reply_byte_ready(reply_byte_ready), .session_open(session_open), .session(session), .configured(configured),
    .width(width), .height(height), .centre2(centre2), .blanking(blanking), .gap_seed(gap_seed), .depth(depth),
    .row_start(row_start), .row_done(row_done), .row_refusal(row_refusal),
    .burst_ready(1'b1), .burst_request(burst_request), .expect_span(expect_span), .burst_kind(burst_kind), .burst_rewind(burst_rewind), .burst_advance(burst_advance),
    .burst_done(burst_done), .burst_refusal(burst_refusal), .burst_detail(burst_detail), .answer_length(12'd298),
    .answer_begin(answer_begin), .answer_next(answer_next), .answering(answering),
    .answer_byte(record_second), .burst(burst), .silence(silent), .acknowledge(acknowledge),
    .acknowledge_window(acknowledge_window), .drop_rows(drop_rows), .drop_next_row(drop_next_row),
    .new_session(new_session), .hold(hold), .acknowledged(acknowledged), .next_row_in(next_row_in),
    .rows_waiting(rows_waiting), .rows_held(rows_held), .core_busy(core_busy), .shadow_in_use(shadow_in_use),
    .frame_start(frame_start), .frame_number(frame_number), .generation(generation), .active_bank(active_bank),
    .shapes(shapes), .commit_pending(commit_pending), .commit_frame(commit_frame), .row_accepted(row_accepted), .row_left(row_left),
    .row_repeated(row_repeated), .row_unneeded(row_unneeded), .sample_over(sample_over), .latency_valid(latency_valid),
    .first_latency(first_latency), .last_latency(last_latency), .step_write(step_write), .node_write(node_write),
    .table_bank(table_bank), .table_entry(table_entry), .table_data(table_data), .table_read(table_read),
    .step_port(step_port), .node_port_0(node_port_0), .node_port_1(node_port_1), .idle(idle)
);

integer            stall, seed, faults, clocks, i, n;
reg     [8*60-1:0] what;                    // is being tested

task fault(input [8*60-1:0] wrong);
    begin
        faults = faults + 1;
        $display("FAIL %0s: %0s (stall %0d, kind %h, reply %h of %0d: %h %h %h %h)", what, wrong, stall, packet_kind, got_kind,
                 got_total, got[0], got[1], got[2], got[3]);
        if (faults > 20) $finish;
    end
endtask

task check(input good, input [8*60-1:0] wrong);
    if (good !== 1'b1) fault(wrong);
endtask

task passed;
    if (faults == 0) $display("PASS %0s", what);
endtask

// The sender, with pauses.
function pause(input integer pattern);
    case (pattern)
        0:       pause = 0;
        1:       pause = $random(seed);
        default: pause = ($random(seed) & 7) != 0;
    endcase
endfunction

always @(posedge clk) begin
    if (reply_byte_valid && reply_byte_ready) begin
        got[got_total] = reply_byte;
        got_total      = got_total + 1;
        if (^reply_byte === 1'bx) fault("an undefined byte");
        if (got_total > got_length) fault("more bytes than were announced");
    end
    if (reply_valid && reply_taken) begin
        {got_kind, got_session, got_sequence, got_length} = {reply_kind, reply_session, reply_sequence, reply_length};
        got_total = 0;
        replies   = replies + 1;
        if (^{reply_kind, reply_session, reply_sequence, reply_length} === 1'bx || reply_flag !== 1'b1) fault("a header");
    end
    #1;
    reply_byte_ready = !pause(stall);
    reply_taken      = 0;
    #1 reply_taken   = reply_valid && !pause(stall);
end

// What the row path sees, and its answers.
always @(posedge clk) begin
    row_done <= row_start;
    row_refusal <= row_start ? row_answer : 4'hx;
    if (acknowledge) begin
        acknowledges     = acknowledges + 1;
        last_acknowledge = acknowledge_window;
    end
    if (row_start) begin
        row_starts = row_starts + 1;
        if (hold) fault("rows are held while one arrives");
    end
    if (drop_rows) begin
        drops     = drops + 1;
        last_drop = drop_next_row;
        if (new_session) new_sessions = new_sessions + 1;
    end
    if (table_read && !hold) fault("tables are read while rows may enter");
end

task start_up;
    begin
        {packet_valid, crc_error, framing_error, millisecond, row_done} = 0;
        {burst, burst_done, burst_rewind, burst_advance, burst_refusal, burst_detail, silences, burst_requests} = 0;
        {rows_waiting, rows_held, core_busy, shadow_in_use, frame_start} = 0;
        {row_accepted, row_left, row_repeated, row_unneeded, sample_over, latency_valid} = 0;
        {acknowledges, row_starts, drops, new_sessions, replies, got_total, writes, faults, clocks} = 0;
        {acknowledged, next_row_in, packet_sequence, packet_window, row_answer, stall} = 0;
        seed = 1;
        rst  = 1;
        repeat (4) @(negedge clk);
        rst = 0;
    end
endtask

// A packet is given to the board, until it is done with it. Every reply repeats its sequence number.
task give(input [7:0] kind, input [15:0] length, input [7:0] of_session);
    integer before, limit;
    begin
        @(negedge clk);
        before          = replies;
        packet_kind     = kind;
        packet_length   = length;
        packet_session  = of_session;
        packet_sequence = packet_sequence + 16'd257;
        packet_valid    = 1;
        limit           = 0;
        while (packet_done !== 1'b1 && limit < 400000) begin
            @(negedge clk);
            limit = limit + 1;
        end
        check(packet_done, "the packet is never done");
        @(negedge clk);
        packet_valid = 0;
        check(replies - before < 2, "more than one reply");
        if (replies == before) got_kind = NO_KIND;
        else begin
            check(got_total == got_length, "the reply's length");
            check(got_sequence == packet_sequence, "the reply's sequence number");
            check(got_session == (got_kind == 8'h7f ? of_session : kind == HELLO ? session : of_session), "the reply's session");
        end
        {packet_kind, packet_session, packet_length} = 32'hx;
        @(negedge clk);
    end
endtask

task refused(input [7:0] kind, input integer code, input integer detail);
    begin
        check(got_kind === 8'h7f, "a refusal is missing");
        check(got_total == 4 && {got[3], got[2], got[1], got[0]} === {detail[15:0], kind, code[7:0]}, "another refusal");
    end
endtask

task replied(input [7:0] kind, input integer length);
    begin
        check(got_kind === kind, "a reply is missing");
        check(got_total == length, "the reply is too short or too long");
    end
endtask

task unanswered;
    check(got_kind === NO_KIND, "a reply where there should be none");
endtask

task put16(input integer place, input [15:0] value);
    {payload[place+1], payload[place]} = value;
endtask

task put32(input integer place, input [31:0] value);
    {payload[place+3], payload[place+2], payload[place+1], payload[place]} = value;
endtask

task hello(input [31:0] nonce, input [31:0] host, input [7:0] least, input [7:0] most, input [7:0] take_over);
    begin
        put32(0, nonce);
        put32(4, host);
        {payload[10], payload[9], payload[8]} = {take_over, most, least};
        give(HELLO, 11, 0);
    end
endtask

task put_span(input integer of_table, input integer bank, input integer port, input integer first, input integer count);
    begin
        {payload[2], payload[1], payload[0]} = {port[7:0], bank[7:0], of_table[7:0]};
        put16(3, first);
        put16(5, count);
    end
endtask

function [31:0] crc_step(input [31:0] crc, input [7:0] data);
    integer k;
    begin
        crc_step = crc ^ data;
        for (k = 0; k < 8; k = k + 1) crc_step = (crc_step >> 1) ^ (crc_step[0] ? 32'hedb88320 : 0);
    end
endfunction

// CRC of the first entries that a bank holds.
function [31:0] table_crc(input kernel, input bank, input integer count);
    integer e, b;
    begin
        table_crc = 32'hffffffff;
        for (e = 0; e < count; e = e + 1)
            for (b = 0; b < (kernel ? 10 : 4); b = b + 1)
                table_crc = crc_step(table_crc, kernel ? nodes_0[bank*128+e] >> 8 * b : {7'd0, steps[bank*4096+e]} >> 8 * b);
        table_crc = ~table_crc;
    end
endfunction

task commit(input [31:0] steps_crc, input [31:0] kernel_crc, input [15:0] frame, input [7:0] as_generation);
    begin
        put32(0, steps_crc);
        put32(4, kernel_crc);
        put16(8, frame);
        payload[10] = as_generation;
        give(COMMIT, 11, session);
    end
endtask

task commit_shadow(input [15:0] frame, input [7:0] as_generation);
    commit(table_crc(0, TABLE_BANKS == 2 && !active_bank, height), table_crc(1, TABLE_BANKS == 2 && !active_bank, 65), frame,
           as_generation);
endtask

task configure(input integer w, input integer h, input integer c, input integer b, input [31:0] s, input integer bits);
    begin
        put16(0, w);
        put16(2, h);
        put16(4, c);
        put16(6, b);
        put32(8, s);
        payload[12] = bits;
        give(CONFIGURE, 13, session);
    end
endtask

task begin_frame(input [15:0] number);
    begin
        frame_start  = 1;
        frame_number = number;
        @(negedge clk);
        frame_start  = 0;
        frame_number = 16'hx;
        @(negedge clk);
    end
endtask
