// The payload of a reply, byte by byte, from where its kind has it.
`default_nettype none

module halfrow_reply #(
    parameter [31:0] BUILD = 32'd0
) (
    input  wire        clk,
    input  wire        rst,
    input  wire        begin_payload,    // pulse; `done` when `length` bytes are gone
    input  wire [11:0] length,
    output wire        done,             // level, from then on
    input  wire [ 2:0] source,           // where the bytes come from, as numbered below
    input  wire [11:0] index,            // of the byte that is fetched, 0 with begin_payload
    output wire        advance,          // on to the next index

    input  wire [ 7:0] packet_byte,      // each belongs to the index of one clock before
    input  wire [ 7:0] session,
    input  wire [63:0] serial,
    input  wire [ 7:0] capabilities_byte,
    input  wire [ 7:0] status_byte,
    input  wire [31:0] crc,
    input  wire [ 7:0] generation,
    input  wire [31:0] refusal,
    input  wire        table_byte_valid,
    input  wire [ 7:0] table_byte,
    output wire        table_byte_ready,

    output reg         byte_valid,
    output reg  [ 7:0] byte_data,
    input  wire        byte_ready
);
    localparam [2:0] ECHO = 3'd0, HELLO = 3'd1, CAPABILITIES = 3'd2, STATUS = 3'd3, TABLE_READ = 3'd4, TABLE_CRC = 3'd5, COMMIT = 3'd6;

    localparam [ 7:0] VERSION = 8'd1;
    localparam [31:0] MAGIC   = "1WRH";    // the first byte in [7:0]

    // The hello's bytes from 4 on, moved so that index[4:0] selects them.
    wire [255:0] hello = {80'd0, serial, BUILD, session, VERSION, MAGIC, 32'd0};
    wire [  7:0] hello_byte = index[4:2] == 3'd0 ? packet_byte : hello[{index[4:0], 3'd0} +: 8];
    wire [  7:0] crc_byte = crc[{index[1:0], 3'd0} +: 8];
    wire [  7:0] refusal_byte = refusal[{index[1:0], 3'd0} +: 8];

    reg [7:0] value;
    reg       in_table;                  // behind the span
    always @* begin
        case (source)
            ECHO:         value = packet_byte;
            HELLO:        value = hello_byte;
            CAPABILITIES: value = capabilities_byte;
            STATUS:       value = status_byte;
            TABLE_READ:   value = in_table ? table_byte : packet_byte;
            TABLE_CRC:    value = crc_byte;
            COMMIT:       value = generation;
            default:      value = refusal_byte;
        endcase
    end

    reg  active, fetched;
    wire last      = index == length;
    wire wait_table = source == TABLE_READ && in_table && !table_byte_valid;

    assign done = active && last && !byte_valid;
    assign advance = active && fetched && !last && !wait_table && (!byte_valid || byte_ready);
    assign table_byte_ready = advance && source == TABLE_READ && in_table;

    always @(posedge clk) begin
        fetched  <= active && !advance;
        in_table <= index >= 12'd7;
        if (begin_payload) active <= 1'b1;
        else if (done) active <= 1'b0;
        if (advance) begin
            byte_valid <= 1'b1;
            byte_data  <= value;
        end else if (byte_ready) byte_valid <= 1'b0;
        if (rst) {active, byte_valid, fetched} <= 3'd0;
    end
endmodule

`default_nettype wire
