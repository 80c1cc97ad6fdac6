// Makes packets of what its two clients have to say, replies before rows, and puts them on the link, stuffed and
// between zeros. A packet that was taken is sent to its end.
`default_nettype none

module halfrow_sender (
    input  wire        clk,
    input  wire        rst,

    input  wire        reply_valid,  // the header's fields are stable up to `taken`
    input  wire [7:0]  reply_kind,
    input  wire [15:0] reply_sequence,
    input  wire [15:0] reply_length, // bytes of payload, 0 to 4080
    input  wire        reply_flag,   // bit 0 of the header's flags
    input  wire [7:0]  reply_session,
    output wire        reply_taken,  // pulse: the header has gone, exactly length bytes must follow
    input  wire        reply_byte_valid,
    input  wire [7:0]  reply_byte,
    output wire        reply_byte_ready,

    input  wire        row_valid,    // may be taken back; the fields are stable up to the payload's first byte
    input  wire [7:0]  row_kind,
    input  wire [15:0] row_sequence,
    input  wire [15:0] row_length,
    input  wire        row_flag,
    input  wire [7:0]  row_session,
    output wire        row_taken,    // pulse: the header goes now, at least one byte of payload must follow
    input  wire        row_byte_valid,
    input  wire [7:0]  row_byte,
    output wire        row_byte_ready,

    input  wire [31:0] window,       // latched with the header

    output wire        tx_valid,
    output wire [7:0]  tx_data,
    input  wire        tx_ready,
    output wire        idle          // nothing under way
);
    `include "halfrow_wire.vh"

    localparam IDLE = 2'd0, HEADER = 2'd1, PAYLOAD = 2'd2, CLOSE = 2'd3;

    reg [1:0] state, next_state;
    reg of_row;       // the packet under way is the row client's
    reg reply_goes, row_goes; // the state is PAYLOAD, of a reply or of a row
    reg [3:0] count;  // bytes of header and CRC that went, and one more
    reg [11:0] left;  // bytes of payload to come
    reg [7:0] header; // its byte to go
    reg [31:0] window_now;
    reg [31:0] crc;
    reg stage_valid;
    reg [7:0] stage_byte;
    reg stage_last;

    wire stuffer_ready, stuffer_idle;
    wire [31:0] crc_next;
    wire free = !stage_valid || stuffer_ready;
    wire offered = (reply_goes && reply_byte_valid) || (row_goes && row_byte_valid);
    wire move = free && (state == HEADER || state == CLOSE || offered);
    wire [7:0] payload_byte = of_row ? row_byte : reply_byte;
    wire [7:0] body_byte = state == HEADER ? header : payload_byte;
    wire header_ends = state == HEADER && free && count == 4'd12;
    wire last = count == 4'd0;

    assign reply_taken = header_ends && !of_row;
    assign row_taken = state == IDLE && row_valid && !reply_valid;
    assign reply_byte_ready = reply_goes && free;
    assign row_byte_ready = row_goes && free;
    assign idle = state == IDLE && !stage_valid && stuffer_idle;

    wire [7:0] kind = of_row ? row_kind : reply_kind;
    wire [7:0] flags = {7'd0, of_row ? row_flag : reply_flag};
    wire [7:0] session = of_row ? row_session : reply_session;
    wire [15:0] sequence_now = of_row ? row_sequence : reply_sequence;
    wire [15:0] length = of_row ? row_length : reply_length;

    // Kept, because the mapper would trade look-up tables for depth.
    (* keep = "true" *) wire [7:0] sequence_byte;
    assign sequence_byte = count[0] ? sequence_now[15:8] : sequence_now[7:0];
    (* keep = "true" *) wire [7:0] length_byte;
    assign length_byte = count[0] ? length[15:8] : length[7:0];
    (* keep = "true" *) wire [7:0] window_byte;
    assign window_byte = window_now[{count[1:0], 3'd0} +: 8];
    (* keep = "true" *) wire [7:0] name_byte;
    assign name_byte = count[2] ? session : kind;
    wire named = !count[3] && count[2] == count[1];
    wire [7:0] counted = count[2] ? length_byte : sequence_byte;
    wire [7:0] field = count == 4'd6 ? flags : count[3] ? window_byte : named ? name_byte : counted;

    always @(posedge clk) begin
        if (state == IDLE) begin
            of_row <= !reply_valid;
            window_now <= window;
            header <= WIRE_VERSION;
        end else if (move) header <= field;
        if (state == HEADER) left <= length[11:0];
        else if (move) left <= left - 12'd1;
        // What is shifted in is what the next packet's CRC begins with.
        if (move) begin
            crc <= state == CLOSE ? {8'hff, crc[31:8]} : crc_next;
            if (state != PAYLOAD) count <= last ? 4'd1 : count + 4'd1;
        end
        if (rst) begin
            crc <= 32'hFFFFFFFF;
            count <= 4'd1;
        end
    end

    always @* begin
        next_state = state;
        case (state)
            IDLE: if (reply_valid || row_valid) next_state = HEADER;
            HEADER: if (header_ends) next_state = left == 12'd0 ? CLOSE : PAYLOAD;
            PAYLOAD: if (move && left == 12'd1) next_state = CLOSE;
            default: if (move && last) next_state = IDLE;
        endcase
        if (rst) next_state = IDLE;
    end

    always @(posedge clk) begin
        state <= next_state;
        reply_goes <= next_state == PAYLOAD && !of_row;
        row_goes <= next_state == PAYLOAD && of_row;
    end

    always @(posedge clk) begin
        if (free) begin
            stage_valid <= move;
            stage_byte <= state == CLOSE ? ~crc[7:0] : body_byte;
            stage_last <= last;
        end
        if (rst) stage_valid <= 1'b0;
    end

    halfrow_crc32 crc32 (.crc(crc), .data(body_byte), .next(crc_next));

    halfrow_stuffer stuffer (
        .clk(clk), .rst(rst),
        .in_valid(stage_valid), .in_data(stage_byte), .in_last(stage_last), .in_ready(stuffer_ready),
        .out_valid(tx_valid), .out_data(tx_data), .out_ready(tx_ready), .idle(stuffer_idle));
endmodule

`default_nettype wire
