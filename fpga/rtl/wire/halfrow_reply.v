// The payload of a reply, byte by byte, from where its kind has it.
`default_nettype none

module halfrow_reply #(
    parameter [31:0] BUILD = 32'd0
) (
    input  wire        clk,
    input  wire        rst,
    input  wire        begin_payload, // pulse; `done` when `length` bytes are gone
    input  wire [11:0] length,
    output wire        done,          // level, from then on
    input  wire [2:0]  source,        // where the bytes come from
    input  wire [11:0] index,         // of the byte that is fetched, 0 with begin_payload
    output wire        advance,       // on to the next index

    input  wire [7:0]  packet_byte,   // one clock behind its index
    input  wire [7:0]  status_byte,   // two, and 0 unless the reply is its
    input  wire [7:0]  capabilities_byte,
    input  wire [7:0]  session,
    input  wire [63:0] serial,
    input  wire [31:0] crc,
    input  wire [7:0]  generation,
    input  wire [31:0] refusal,
    input  wire        table_byte_valid,
    input  wire [7:0]  table_byte,
    output wire        table_byte_ready,

    output reg         byte_valid,
    output reg  [7:0]  byte_data,
    input  wire        byte_ready
);
    `include "halfrow_wire.vh"
    `include "halfrow_board.vh"

    // The hello's bytes: the packet's, these, and from 14 on the serial number, turned so that index[2:0] selects its
    // bytes.
    wire [63:0] turned_serial = {serial[15:0], serial[63:16]};
    wire [7:0] build_low = index[0] ? BUILD[15:8] : BUILD[7:0];
    wire [7:0] build_high = index[0] ? BUILD[31:24] : BUILD[23:16];
    wire [7:0] build_byte = index[2] ? build_high : build_low;
    wire [7:0] session_byte = index[0] ? session : WIRE_VERSION;
    wire in_serial = index[4] || &index[3:1];
    reg [7:0] serial_high, serial_low, middle_byte, capability, crc_byte, refusal_byte;

    // All but one of these are 0.
    always @(posedge clk) begin
        if (source != FROM_HELLO || !in_serial || index[2]) serial_low <= 8'd0;
        else serial_low <= turned_serial[{1'b0, index[1:0], 3'd0} +: 8];
        if (source != FROM_HELLO || !in_serial || !index[2]) serial_high <= 8'd0;
        else serial_high <= turned_serial[{1'b1, index[1:0], 3'd0} +: 8];
        if (source != FROM_HELLO || in_serial) middle_byte <= 8'd0;
        else
            middle_byte <= !index[3] ? WIRE_MAGIC[{index[1:0], 3'd0} +: 8]
                           : index[2:1] != 2'd0 ? build_byte : session_byte;
        if (source != FROM_CAPABILITIES && source != FROM_COMMIT) capability <= 8'd0;
        else capability <= source[2] ? generation : capabilities_byte;
        if (source != FROM_CRC) crc_byte <= 8'd0;
        else crc_byte <= crc[{index[1:0], 3'd0} +: 8];
        if (source != FROM_REFUSAL) refusal_byte <= 8'd0;
        else refusal_byte <= refusal[{index[1:0], 3'd0} +: 8];
    end

    // Only a table's byte comes as it is, the rest is two clocks behind its index.
    reg [7:0] made;
    reg in_table; // behind the span
    reg from_packet;

    always @(posedge clk) begin
        made <= from_packet ? packet_byte
                            : serial_low | serial_high | middle_byte | capability | crc_byte | refusal_byte;
        in_table <= source == FROM_TABLE && index >= 12'd7;
        from_packet <= source == FROM_PACKET || (source == FROM_TABLE && index < 12'd7)
                       || (source == FROM_HELLO && index < 12'd4);
    end

    wire [7:0] value = in_table ? table_byte : made | status_byte;

    reg active, settled, fetched;
    reg last; // index == length, a clock later
    reg wait_table; // nobody else takes the table's bytes, so this may come a clock late

    assign done = settled && last && !byte_valid;
    // A byte takes three clocks to fetch, so one that waits for the byte in front to have gone loses none.
    assign advance = active && fetched && !last && !wait_table && !byte_valid;
    assign table_byte_ready = advance && in_table;

    always @(posedge clk) begin
        last <= index == length;
        wait_table <= in_table && !table_byte_valid;
        settled <= active && !advance && !done;
        fetched <= settled && !advance;
        if (begin_payload) active <= 1'b1;
        else if (done) active <= 1'b0;
        if (advance) begin
            byte_valid <= 1'b1;
            byte_data <= value;
        end else if (byte_ready) byte_valid <= 1'b0;
        if (rst) {active, byte_valid, settled, fetched} <= 4'd0;
    end
endmodule

`default_nettype wire
