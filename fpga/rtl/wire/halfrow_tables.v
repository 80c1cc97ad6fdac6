// Carries out what requests want of the tables: writes checked as a whole first, reads and CRCs through the
// datapath's ports, commits; and wipes both banks at power-up and when it is told to.
`default_nettype none

module halfrow_tables #(
    parameter MAX_HEIGHT = 2048,
    parameter GRID = 0,
    parameter ENTRY_BITS = 11,
    parameter TAPS = 7,
    parameter TABLE_BANKS = 2
) (
    input  wire                  clk,
    input  wire                  rst,
    input  wire                  wipe,      // pulse
    output wire                  ready,     // nothing is under way

    input  wire                  start,     // pulse; the request stands still from two clocks before on
    input  wire [1:0]            request,   // the kind's low bits: TABLE_WRITE to COMMIT
    input  wire [103:0]          fields,    // the payload's start, its first byte in [7:0]
    input  wire                  has_shape, // a COMMIT has the fields v and k
    output wire                  finished,  // pulse: with refusal and detail; of a TABLE_READ only that it may be sent
    output reg  [3:0]            refusal,   // 0 for none
    output reg  [15:0]           detail,
    input  wire                  send,      // pulse: the entries of a TABLE_READ are wanted
    output reg  [31:0]           crc,       // of what was read, before the inversion

    output wire                  rewind,    // pulse: the packet's entries are read from the first on
    output wire                  advance,   // by one byte
    input  wire [7:0]            packet_byte,
    output wire                  byte_valid,
    output wire [7:0]            byte_read,
    input  wire                  byte_ready,

    input  wire                  configured,
    input  wire [11:0]           width,
    input  wire [11:0]           height,
    input  wire                  core_busy,
    input  wire                  shadow_in_use,
    input  wire                  forget,    // pulse: a pending commit
    input  wire                  frame_start,
    input  wire [15:0]           frame_number,
    output wire [7:0]            generation,
    output wire                  active_bank,
    output wire [7:0]            shapes,    // {k is 6, v} of bank 1 and of bank 0
    output wire                  commit_pending,
    output wire [15:0]           commit_frame,

    output wire                  step_write,
    output wire                  node_write,
    output wire                  table_bank,
    output wire [ENTRY_BITS-1:0] table_entry,
    output wire [79:0]           table_data,
    output wire                  table_read,
    input  wire [24:0]           step_port,
    input  wire [79:0]           node_port_0,
    input  wire [79:0]           node_port_1
);
    `include "halfrow_wire.vh"
    `include "halfrow_board.vh"

    localparam [1:0] TABLE_WRITE = KIND_TABLE_WRITE[1:0], TABLE_READ = KIND_TABLE_READ[1:0];
    localparam [1:0] TABLE_CRC = KIND_TABLE_CRC[1:0], COMMIT = KIND_COMMIT[1:0];
    localparam IDLE = 3'd0, JUDGE = 3'd1, CHECKING = 3'd2, WRITING = 3'd3, READING = 3'd4, COMMITTING = 3'd5,
               WIPING = 3'd6, FINISH = 3'd7;

    localparam [3:0] NONE = 4'd0;
    localparam [12:0] STEPS = MAX_HEIGHT[12:0];
    localparam [12:0] ENTRIES = GRID == 1 ? 13'd1 << ENTRY_BITS : STEPS;
    localparam [15:0] MOST_STEPS_OF_A_READ = (MOST_PAYLOAD - SPAN_BYTES) / 16'd4;
    localparam [1:0] LAST_WIPE = TABLE_BANKS == 2 ? 2'd3 : 2'd1;

    wire span_kernel = fields[1:0] == TABLE_KERNEL;
    wire span_grid = GRID == 1 && fields[1:0] == TABLE_GRID;
    wire span_active = fields[8];
    wire [7:0] span_port = fields[23:16];
    wire [15:0] span_first = fields[39:24];
    wire [15:0] span_count = fields[55:40];
    wire [31:0] steps_crc = fields[31:0];
    wire [31:0] kernel_crc = fields[63:32];
    wire [15:0] first_frame = fields[79:64];
    wire [7:0] new_generation = fields[87:80];
    wire [7:0] new_v = fields[95:88];
    wire [7:0] new_k = fields[103:96];

    reg past_end, no_such_port, too_long;
    reg [16:0] span_end;
    always @(posedge clk) begin
        span_end <= {1'b0, span_first} + {1'b0, span_count};
        past_end <= span_end > {4'd0, span_kernel ? NODES[12:0] : span_grid ? ENTRIES : STEPS};
        no_such_port <= span_kernel ? span_port[7:1] != 7'd0 : span_port != 8'd0;
        too_long <= span_count > MOST_STEPS_OF_A_READ; // a kernel always fits
    end

    // The shape that a COMMIT names.
    wire new_grid = GRID == 1 && has_shape && new_v != 8'd0;
    wire new_v_wrong = new_grid && new_v > 8'd6;
    wire sized;
    wire [17:0] size;
    reg new_grid_wrong;

    generate
        if (GRID == 1) begin : grids
            halfrow_grid_size grid_size (
                .clk(clk), .start(start), .v(new_v[2:0]), .long_segments(new_k[1]), .width(width), .height(height),
                .done(sized), .entries(size));
        end else begin : no_grids
            assign sized = 1'b1;
            assign size = 18'd0;
            wire unused = &{1'b0, width};
        end
    endgenerate

    reg weighed; // new_grid_wrong is of the size
    always @(posedge clk) begin
        weighed <= sized && !start;
        new_grid_wrong <= new_grid && ((new_k != 8'd5 && new_k != 8'd6) || size > {5'd0, ENTRIES});
    end

    // The walks of a commit: steps, kernel by port 0, kernel by port 1. Those of wiping: steps and kernel of each bank.
    reg [2:0] state;
    reg [1:0] walk;
    reg begin_walk;
    wire committing = state == COMMITTING;
    wire wiping = state == WIPING;
    wire of_span = !committing && !wiping;
    wire kernel = committing ? walk != 2'd0 : wiping ? walk[0] : span_kernel;
    wire port = committing ? walk[1] : span_port[0];
    wire walked, illegal, known, shadow_bank;

    wire [ENTRY_BITS-1:0] first = of_span ? span_first[ENTRY_BITS-1:0] : {ENTRY_BITS{1'b0}};
    wire [12:0] count = of_span ? span_count[12:0] : kernel ? NODES[12:0] : wiping ? ENTRIES
                        : new_grid ? size[12:0] : {1'b0, height};
    wire [1:0] task_kind = wiping ? TASK_WIPE : state == CHECKING ? TASK_CHECK
                           : state == WRITING ? TASK_WRITE : TASK_READ;

    assign table_bank = wiping ? walk[1] : of_span && span_active ? active_bank : shadow_bank;
    assign table_read = state == READING || committing;
    assign ready = state == IDLE;
    assign finished = state == FINISH;
    assign rewind = begin_walk && (state == CHECKING || state == WRITING);

    halfrow_table_port #(.ENTRY_BITS(ENTRY_BITS), .TAPS(TAPS)) table_port (
        .clk(clk), .rst(rst), .start(begin_walk), .task_kind(task_kind), .kernel(kernel), .grid(span_grid), .port(port),
        .first(first), .count(count), .done(walked), .illegal(illegal), .advance(advance), .packet_byte(packet_byte),
        .byte_valid(byte_valid), .byte_read(byte_read), .byte_ready(byte_ready || committing || request == TABLE_CRC),
        .step_write(step_write), .node_write(node_write), .table_entry(table_entry), .table_data(table_data),
        .step_port(step_port), .node_port_0(node_port_0), .node_port_1(node_port_1));

    wire [31:0] crc_next;
    halfrow_crc32 crc32 (.crc(crc), .data(byte_read), .next(crc_next));

    always @(posedge clk) begin
        if (begin_walk) crc <= 32'hFFFFFFFF;
        else if (byte_valid) crc <= crc_next;
    end

    wire steps_right, kernel_right;
    halfrow_equal #(.WIDTH(32)) steps_equal (.clk(clk), .a(~crc), .b(steps_crc), .equal(steps_right));
    halfrow_equal #(.WIDTH(32)) kernel_equal (.clk(clk), .a(~crc), .b(kernel_crc), .equal(kernel_right));

    reg compared; // a commit's walk is over and its CRC was looked at
    wire crc_right = walk == 2'd0 ? steps_right : kernel_right;
    wire commit = committing && compared && crc_right && walk == 2'd2;
    always @(posedge clk) compared <= walked;

    halfrow_generations #(.TABLE_BANKS(TABLE_BANKS)) generations (
        .clk(clk), .wipe(rst || wipe), .forget(rst || forget), .commit(commit), .new_generation(new_generation),
        .new_shape(new_grid ? {new_k[1], new_v[2:0]} : 4'd0),
        .factor_written(step_write && state == WRITING && !span_grid), .first_frame(first_frame),
        .frame_start(frame_start), .frame_number(frame_number), .known(known), .generation(generation),
        .active_bank(active_bank), .shadow_bank(shadow_bank), .shapes(shapes), .commit_pending(commit_pending),
        .commit_frame(commit_frame));

    always @(posedge clk) begin
        begin_walk <= 1'b0;
        case (state)
            IDLE: begin
                refusal <= NONE;
                detail <= span_first;
                walk <= 2'd0;
                if (start) state <= JUDGE;
                else if (send) begin
                    begin_walk <= 1'b1;
                    state <= READING;
                end
            end
            JUDGE: begin
                state <= FINISH;
                case (request)
                    TABLE_WRITE:
                    if (span_active) refusal <= REFUSAL_RANGE;
                    else if (shadow_in_use || commit_pending) {refusal, detail} <= {REFUSAL_BUSY, 16'd0};
                    else if (past_end) refusal <= REFUSAL_RANGE;
                    else begin
                        begin_walk <= 1'b1;
                        state <= CHECKING;
                    end
                    COMMIT: begin
                        detail <= 16'd0;
                        if (known) state <= FINISH;
                        else if (!weighed) state <= JUDGE;
                        else if (!configured) refusal <= REFUSAL_NOT_READY;
                        else if (new_generation == 8'd0) refusal <= REFUSAL_RANGE;
                        else if (new_v_wrong) {refusal, detail} <= {REFUSAL_RANGE, 16'd1};
                        else if (new_grid_wrong) {refusal, detail} <= {REFUSAL_RANGE, 16'd2};
                        else if (commit_pending || core_busy) refusal <= REFUSAL_BUSY;
                        else begin
                            begin_walk <= 1'b1;
                            state <= COMMITTING;
                        end
                    end
                    default:
                    if (core_busy) {refusal, detail} <= {REFUSAL_BUSY, 16'd0};
                    else if (no_such_port || past_end || (too_long && request == TABLE_READ)) refusal <= REFUSAL_RANGE;
                    else if (request == TABLE_CRC) begin
                        begin_walk <= 1'b1;
                        state <= READING;
                    end
                endcase
            end
            CHECKING: begin
                if (walked) begin
                    begin_walk <= 1'b1;
                    state <= WRITING;
                end
                if (illegal) begin
                    refusal <= kernel ? REFUSAL_TAPS : REFUSAL_RANGE;
                    detail <= {{16 - ENTRY_BITS{1'b0}}, table_entry};
                    state <= FINISH;
                end
            end
            WRITING: if (walked) state <= FINISH;
            READING: if (walked) state <= request == TABLE_CRC ? FINISH : IDLE;
            COMMITTING:
            if (compared) begin
                walk <= walk + 2'd1;
                begin_walk <= crc_right && walk != 2'd2;
                if (!crc_right)
                    {refusal, detail} <= {REFUSAL_TABLE_CRC, 14'd0, walk != 2'd0 ? TABLE_KERNEL
                                                                    : new_grid ? TABLE_GRID : TABLE_STEPS};
                if (!crc_right || walk == 2'd2) state <= FINISH;
            end
            WIPING:
            if (walked) begin
                walk <= walk + 2'd1;
                begin_walk <= walk != LAST_WIPE;
                if (walk == LAST_WIPE) state <= IDLE;
            end
            default: state <= IDLE;
        endcase
        if (rst || wipe) begin
            state <= WIPING;
            walk <= 2'd0;
            begin_walk <= 1'b1;
        end
    end
endmodule

`default_nettype wire
