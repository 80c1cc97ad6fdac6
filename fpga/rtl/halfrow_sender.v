// Makes packets of what its two clients have to say, replies before rows, and puts them on the link, stuffed and between
// zeros. A packet that was taken is sent to its end.
`default_nettype none

module halfrow_sender (
    input  wire        clk,
    input  wire        rst,

    // header fields: stable from valid to taken
    input  wire        reply_valid,
    input  wire [ 7:0] reply_kind,
    input  wire [15:0] reply_sequence,
    input  wire [15:0] reply_length,      // bytes of payload, 0 to 4080
    input  wire        reply_flag,        // bit 0 of the header's flags
    input  wire [ 7:0] reply_session,
    output wire        reply_taken,       // pulse: the header is latched, exactly length bytes must follow
    input  wire        reply_byte_valid,
    input  wire [ 7:0] reply_byte,
    output wire        reply_byte_ready,

    input  wire        row_valid,
    input  wire [ 7:0] row_kind,
    input  wire [15:0] row_sequence,
    input  wire [15:0] row_length,
    input  wire        row_flag,
    input  wire [ 7:0] row_session,
    output wire        row_taken,
    input  wire        row_byte_valid,
    input  wire [ 7:0] row_byte,
    output wire        row_byte_ready,

    input  wire [31:0] window,            // latched with the header

    output wire        tx_valid,
    output wire [ 7:0] tx_data,
    input  wire        tx_ready,
    output wire        idle               // nothing under way
);
    localparam IDLE = 2'd0, HEADER = 2'd1, PAYLOAD = 2'd2, CLOSE = 2'd3;

    localparam [7:0] VERSION = 8'd1;

    reg [ 1:0] state;
    reg        of_row;     // the packet under way is the row client's
    reg [ 3:0] count;      // bytes of header and CRC that went
    reg [11:0] left;       // bytes of payload to come
    reg [95:0] header;     // the byte to go in [7:0]
    reg [31:0] crc;
    reg        stage_valid;
    reg [ 7:0] stage_byte;
    reg        stage_last;

    wire        stuffer_ready, stuffer_idle;
    wire [31:0] crc_next;
    wire        free         = !stage_valid || stuffer_ready;
    wire        offered      = of_row ? row_byte_valid : reply_byte_valid;
    wire        move         = free && (state == HEADER || state == CLOSE || (state == PAYLOAD && offered));
    wire [ 7:0] payload_byte = of_row ? row_byte : reply_byte;
    wire [ 7:0] body_byte    = state == HEADER ? header[7:0] : payload_byte;
    wire        last         = count == 4'd15;

    assign reply_taken      = state == IDLE && reply_valid;
    assign row_taken        = state == IDLE && row_valid && !reply_valid;
    assign reply_byte_ready = state == PAYLOAD && !of_row && free;
    assign row_byte_ready   = state == PAYLOAD && of_row && free;
    assign idle             = state == IDLE && !stage_valid && stuffer_idle;

    wire [87:0] reply_header = {window, reply_session, 7'd0, reply_flag, reply_length, reply_sequence, reply_kind};
    wire [87:0] row_header   = {window, row_session, 7'd0, row_flag, row_length, row_sequence, row_kind};

    // Header and CRC are shifted out, and what is shifted in is what the next packet begins with: version and preset.
    always @(posedge clk) begin
        if (state == IDLE) begin
            of_row       <= !reply_valid;
            header[95:8] <= reply_valid ? reply_header : row_header;
        end else if (state == HEADER && move) begin
            header <= {VERSION, header[95:8]};
            if (count == 4'd4) left <= header[11:0];
        end
        if (state == PAYLOAD && move) left <= left - 12'd1;
        if (move) begin
            crc <= state == CLOSE ? {8'hff, crc[31:8]} : crc_next;
            if (state != PAYLOAD) count <= count + 4'd1;
        end
        if (rst) begin
            header[7:0] <= VERSION;
            crc         <= 32'hFFFFFFFF;
            count       <= 4'd0;
        end
    end

    always @(posedge clk) begin
        case (state)
            IDLE:    if (reply_valid || row_valid) state <= HEADER;
            HEADER:  if (move && count == 4'd11) state <= left == 12'd0 ? CLOSE : PAYLOAD;
            PAYLOAD: if (move && left == 12'd1) state <= CLOSE;
            default: if (move && last) state <= IDLE;
        endcase
        if (rst) state <= IDLE;
    end

    always @(posedge clk) begin
        if (free) begin
            stage_valid <= move;
            stage_byte  <= state == CLOSE ? ~crc[7:0] : body_byte;
            stage_last  <= last;
        end
        if (rst) stage_valid <= 1'b0;
    end

    halfrow_crc32 crc32 (.crc(crc), .data(body_byte), .next(crc_next));

    halfrow_stuffer stuffer (
        .clk(clk), .rst(rst),
        .in_valid(stage_valid), .in_data(stage_byte), .in_last(stage_last), .in_ready(stuffer_ready),
        .out_valid(tx_valid), .out_data(tx_data), .out_ready(tx_ready), .idle(stuffer_idle)
    );
endmodule

`default_nettype wire
