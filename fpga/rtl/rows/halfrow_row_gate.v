// Takes a ROW_IN packet from the receiver's buffer: reads its place, decides what becomes of it, and if it is
// accepted reads it once more, the place into its entry and the samples, two from three bytes, into its in-bank.
`default_nettype none

module halfrow_row_gate #(
    parameter IN_BITS = 1,
    parameter ENTRY_BITS = 2,
    parameter COLUMN_BITS = 11
) (
    input  wire                    clk,
    input  wire                    rst,           // also while rows are dropped

    input  wire                    row_start,     // pulse: a packet lies in the buffer
    output reg                     row_done,      // pulse: it may go
    output reg  [3:0]              row_refusal,   // with row_done: a code, or 0
    output wire                    busy,
    output reg  [11:0]             packet_address,
    input  wire [7:0]              packet_byte,   // one clock behind its address
    input  wire [11:0]             packet_length, // bytes of payload

    input  wire [11:0]             width,
    input  wire [11:0]             height,
    input  wire [COLUMN_BITS-1:0]  last_column,
    input  wire [1:0]              depth,         // 0: 8 bits, 1: 10, 2: 12
    input  wire                    burst,         // one is under way
    input  wire                    has_generation,
    input  wire                    commit_pending,
    input  wire [15:0]             commit_frame,

    input  wire                    settling,
    input  wire [31:0]             acknowledged,
    input  wire [ENTRY_BITS-1:0]   rows_entered,
    input  wire [ENTRY_BITS-1:0]   rows_left,
    input  wire [(1<<IN_BITS)-1:0] waiting,
    input  wire                    played,

    output wire                    place_write,   // of place_byte, the place's byte number place_index
    output wire [ENTRY_BITS-1:0]   entry,         // of the packet's row
    output wire [2:0]              place_index,
    output wire [7:0]              place_byte,
    input  wire                    places_held,   // no entry may be written yet
    output reg  [ENTRY_BITS-1:0]   before_entry,
    output wire [2:0]              before_index,
    input  wire [7:0]              before_byte,   // number before_index of before_entry

    output wire                    sample_write,
    output reg  [COLUMN_BITS-1:0]  column,
    output wire [11:0]             sample,

    output wire                    again,         // pulse: the row's result is to be sent again
    input  wire                    again_waiting, // not before this is low

    output reg                     accepted,      // pulse: the row is in its bank
    output reg                     unneeded,      // pulse
    output reg                     sample_over    // pulse: a sample >= 2^B
);
    `include "halfrow_wire.vh"
    `include "halfrow_board.vh"

    localparam IDLE = 3'd0, SETTLE = 3'd1, PLACE = 3'd2, JUDGE = 3'd3, AGAIN = 3'd4, HOLD = 3'd5, TAKE = 3'd6;

    localparam [3:0] NONE = 4'd0;
    localparam [ENTRY_BITS:0] BANKS_IN = {{ENTRY_BITS{1'b0}}, 1'b1} << IN_BITS;

    reg [2:0] state;
    // The packet's byte gets a register before anything is made of it, since a memory's output comes late in the clock.
    reg [7:0] shown_byte;
    reg [3:0] coming, shown; // its number while it is in the place
    reg coming_valid, shown_valid;
    reg in_samples;          // it is behind the place

    wire reading = state == PLACE || state == TAKE;

    always @(posedge clk) begin
        packet_address <= reading ? packet_address + 12'd1 : 12'd0;
        coming <= packet_address[3:0];
        coming_valid <= reading;
        shown <= coming;
        shown_valid <= coming_valid;
        shown_byte <= packet_byte;
    end

    wire passed, far, last_number, row_0, follows, commit_fits, fits, short;
    wire [ENTRY_BITS-1:0] distance;

    halfrow_row_check #(.ENTRY_BITS(ENTRY_BITS)) check (
        .clk(clk), .begins(state == SETTLE), .byte_valid(state == PLACE && shown_valid), .byte_index(shown),
        .place_byte(shown_byte), .before_index(before_index), .before_byte(before_byte), .packet_length(packet_length),
        .acknowledged(acknowledged), .width(width), .height(height), .commit_frame(commit_frame),
        .entry(entry), .passed(passed), .far(far), .distance(distance), .last_number(last_number),
        .row_0(row_0), .follows(follows), .commit_fits(commit_fits), .fits(fits), .short(short));

    always @(posedge clk)
        before_entry <= entry - 1'b1;

    assign place_index = shown[2:0];
    assign before_index = coming[2:0];
    assign place_byte = shown_byte;

    // A row that waits may be the one that a commit is for, or the right predecessor, as long as it has not come.
    wire [IN_BITS-1:0] bank = entry[IN_BITS-1:0];
    wire known = !far && distance < rows_entered;
    wire has_result = !far && distance < rows_left;
    wire has_credit = !far && !last_number && {1'b0, distance} < {1'b0, rows_entered} + BANKS_IN;
    wire is_next = distance == rows_entered;
    wire waits = waiting[bank];
    wire has_before = is_next ? played : waiting[before_entry[IN_BITS-1:0]];
    wire finds_tables = has_generation || (commit_pending && (commit_fits || !is_next));
    wire in_order = row_0 || (has_before ? follows : !is_next);

    reg [3:0] refusal;
    reg is_again, is_unneeded;

    always @* begin
        refusal = NONE;
        is_again = 1'b0;
        is_unneeded = 1'b0;
        if (short)
            refusal = REFUSAL_PAYLOAD;
        else if (burst)
            refusal = REFUSAL_BUSY;
        else if (passed || known) begin
            is_again = !passed && has_result;
            is_unneeded = passed || !has_result;
        end else if (!has_credit)
            refusal = REFUSAL_CREDIT;
        else if (waits)
            is_unneeded = 1'b1;
        else if (!finds_tables)
            refusal = REFUSAL_NOT_READY;
        else if (!fits || !in_order)
            refusal = REFUSAL_ROW;
    end

    reg [1:0] phase;   // byte of three
    reg [7:0] earlier; // bits of the byte before that are not in a sample yet
    wire taking = shown_valid && in_samples;
    wire all_taken = sample_write && column == last_column;

    assign place_write = state == TAKE && shown_valid && !in_samples && !shown[3];
    assign sample_write = taking && phase != 2'd0;
    assign sample = phase == 2'd1 ? {shown_byte[3:0], earlier} : {shown_byte, earlier[3:0]};

    always @(posedge clk) begin
        if (rst || state != TAKE || all_taken) begin
            in_samples <= 1'b0;
            phase <= 2'd0;
            column <= {COLUMN_BITS{1'b0}};
        end else if (shown_valid) begin
            if (shown == 4'd11)
                in_samples <= 1'b1;
            if (in_samples)
                phase <= phase == 2'd2 ? 2'd0 : phase + 2'd1;
            if (sample_write)
                column <= column + 1'b1;
        end
        earlier <= phase == 2'd1 ? {4'd0, shown_byte[7:4]} : shown_byte;
    end

    assign again = state == AGAIN && !again_waiting;
    assign busy = state != IDLE;

    always @(posedge clk) begin
        row_done <= 1'b0;
        accepted <= 1'b0;
        unneeded <= 1'b0;
        sample_over <= sample_write && ((depth == DEPTH_8 && sample[11:8] != 4'd0)
                                        || (depth == DEPTH_10 && sample[11:10] != 2'd0));
        if (state == JUDGE) begin
            row_refusal <= refusal;
            unneeded <= is_unneeded;
        end
        case (state)
            IDLE: if (row_start) state <= SETTLE;
            SETTLE: if (!settling) state <= PLACE;
            PLACE: if (shown_valid && shown == 4'd14) state <= JUDGE;
            JUDGE: begin
                state <= is_again ? AGAIN : is_unneeded || refusal != NONE ? IDLE : HOLD;
                row_done <= !is_again && (is_unneeded || refusal != NONE);
            end
            AGAIN: if (!again_waiting) begin
                state <= IDLE;
                row_done <= 1'b1;
            end
            HOLD: if (!places_held) state <= TAKE;
            default: if (all_taken) begin
                state <= IDLE;
                row_done <= 1'b1;
                accepted <= 1'b1;
            end
        endcase
        if (rst) begin
            state <= IDLE;
            row_done <= state != IDLE;
            accepted <= 1'b0;
            unneeded <= 1'b0;
            row_refusal <= NONE;
        end
    end
endmodule

`default_nettype wire
