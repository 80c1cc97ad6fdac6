// Finds the packets in the link's bytes, undoes their stuffing, judges them, and keeps a good one until it was dealt
// with.
`default_nettype none

module halfrow_receiver (
    input  wire        clk,
    input  wire        rst,

    input  wire        rx_valid,
    input  wire [7:0]  rx_data,
    output wire        rx_ready,

    output wire        packet_valid,   // a level: a good packet lies here, its header on the next outputs
    output wire [7:0]  packet_kind,
    output wire [15:0] packet_sequence,
    output wire [15:0] packet_length,  // bytes of payload, 0 to 4080
    output wire [7:0]  packet_flags,
    output wire [7:0]  packet_session,
    output wire [31:0] packet_window,
    input  wire        packet_done,    // pulse: the packet may go
    input  wire [11:0] packet_address, // of a payload byte, from 0
    output reg  [7:0]  packet_byte,    // one clock later

    output reg         crc_error,      // pulses, one of them for every damaged packet
    output reg         framing_error
);
    `include "halfrow_wire.vh"

    localparam RECEIVE = 2'd0, JUDGE = 2'd1, HOLD = 2'd2;

    localparam [31:0] RESIDUE = 32'hDEBB20E3; // the CRC register behind a packet and its own CRC
    localparam [12:0] FIRST = 13'd0 - 13'd12;
    localparam [12:0] TOO_MANY = 13'd4085; // 4097 bytes
    localparam [7:0] FULL_CODE = 8'hff;
    reg [1:0] state;
    reg begun;           // bytes came since the last zero
    reg implied;         // the next code byte stands for a zero as well
    reg [7:0] remaining; // bytes up to the next code byte
    reg emit;
    reg [7:0] emit_byte;

    wire take = rx_valid && rx_ready;
    wire zero = rx_data == 8'd0;
    wire at_code = remaining == 8'd0;

    assign rx_ready = state == RECEIVE;
    assign packet_valid = state == HOLD;

    always @(posedge clk) begin
        emit <= take && !zero && (!at_code || implied);
        emit_byte <= at_code ? 8'd0 : rx_data;
        if (rst || state == JUDGE) begin
            begun <= 1'b0;
            implied <= 1'b0;
            remaining <= 8'd0;
        end else if (take && !zero) begin
            begun <= 1'b1;
            remaining <= (at_code ? rx_data : remaining) - 8'd1;
            if (at_code) implied <= rx_data != FULL_CODE;
        end
        if (rst) emit <= 1'b0;
    end

    // The place counts from the payload's first byte, so that the header lies at the buffer's end, behind the longest
    // payload and its CRC, and the payload at 0.
    reg [12:0] place;
    reg [95:0] header;
    reg [31:0] crc;
    wire [31:0] crc_next;
    (* ram_style = "block" *) reg [7:0] buffer [0:4095];
    wire in_header = place[12];
    wire too_many = place == TOO_MANY;

    halfrow_crc32 crc32 (.crc(crc), .data(emit_byte), .next(crc_next));

    always @(posedge clk) begin
        if (rst || state == JUDGE) begin
            place <= FIRST;
            crc <= 32'hFFFFFFFF;
        end else if (emit && !too_many) begin
            place <= place + 13'd1;
            crc <= crc_next;
        end
        if (emit && in_header) header <= {emit_byte, header[95:8]};
    end

    always @(posedge clk) begin
        if (emit) buffer[place[11:0]] <= emit_byte;
        packet_byte <= buffer[packet_address];
    end

    assign packet_kind = header[15:8];
    assign packet_sequence = header[31:16];
    assign packet_length = header[47:32];
    assign packet_flags = header[55:48];
    assign packet_session = header[63:56];
    assign packet_window = header[95:64];

    wire stuffing_good = at_code;
    wire size_good = !in_header && !too_many && place[11:2] != 10'd0;
    wire crc_good = crc == RESIDUE;
    wire fields_good = header[7:0] == WIRE_VERSION && packet_length == {3'd0, place} - 16'd4;
    wire frame_good = stuffing_good && size_good;

    always @(posedge clk) begin
        crc_error <= !rst && state == JUDGE && frame_good && !crc_good;
        framing_error <= !rst && state == JUDGE && !(frame_good && (!crc_good || fields_good));
        case (state)
            RECEIVE: if (take && zero && begun) state <= JUDGE;
            JUDGE: state <= frame_good && crc_good && fields_good ? HOLD : RECEIVE;
            HOLD: if (packet_done) state <= RECEIVE;
            default: state <= RECEIVE;
        endcase
        if (rst) state <= RECEIVE;
    end
endmodule

`default_nettype wire
