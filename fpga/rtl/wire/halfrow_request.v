// What a request's kind is to the dispatcher, and whether its payload has all fields and each of them a meaning.
`default_nettype none

module halfrow_request #(
    parameter TRAP = 1, // there is one
    parameter GRID = 0  // there are grids
) (
    input  wire        clk,
    input  wire [7:0]  kind,
    input  wire [15:0] length,     // bytes of payload, at most 4080
    input  wire [55:0] fields,     // the payload's start, its first byte in [7:0]
    // two clocks behind the inputs
    output reg         unknown,    // no request that the board knows
    output reg         malformed,
    output reg         has_shape,  // of a COMMIT: its fields v and k are there
    output reg  [12:0] read_length // of the reply to a TABLE_READ
);
    `include "halfrow_wire.vh"

    wire [7:0] first_byte = fields[7:0];
    wire span_kernel = fields[1:0] == TABLE_KERNEL;
    wire known_table = fields[7:1] == 7'd0 || (GRID == 1 && first_byte == {6'd0, TABLE_GRID});
    wire [15:0] count = fields[55:40];
    reg [4:0] least; // bytes
    reg short, meaningless, count_too_large;
    reg [13:0] entries_length; // bytes of up to 1023 entries
    reg [15:0] behind_span;    // bytes

    always @* begin
        case (kind)
            KIND_HELLO, KIND_COMMIT: least = 5'd11;
            KIND_STATUS: least = 5'd1;
            KIND_RESET: least = 5'd5;
            KIND_TABLE_WRITE, KIND_TABLE_READ, KIND_TABLE_CRC: least = SPAN_BYTES[4:0];
            KIND_CONFIGURE: least = 5'd13;
            KIND_BURST: least = 5'd17;
            KIND_RECORDS, KIND_EXPECT: least = 5'd4;
            default: least = 5'd0;
        endcase
    end

    always @(posedge clk) begin
        has_shape <= length[11:5] != 7'd0 || length[4:0] >= 5'd13;
        short <= length[11:5] == 7'd0 && length[4:0] < least;
        meaningless <= (kind == KIND_RESET && first_byte > RESET_WIPES)
                        || (kind[7:2] == KIND_TABLE_WRITE[7:2] && kind != KIND_COMMIT
                            && (!known_table || fields[15:9] != 7'd0));
        count_too_large <= count[15:10] != 6'd0;
        entries_length <= (span_kernel ? {1'b0, count[9:0], 3'd0} : {2'd0, count[9:0], 2'd0})
                         + (span_kernel ? {3'd0, count[9:0], 1'b0} : 14'd0);
        behind_span <= length - SPAN_BYTES;
        malformed <= short || meaningless
                        || (kind == KIND_TABLE_WRITE && (count_too_large || {2'd0, entries_length} > behind_span));
        read_length <= entries_length[12:0] + SPAN_BYTES[12:0];
        case (kind)
            KIND_HELLO, KIND_CAPABILITIES, KIND_STATUS, KIND_RESET, KIND_ECHO, KIND_TABLE_WRITE, KIND_TABLE_READ,
            KIND_TABLE_CRC, KIND_COMMIT, KIND_CONFIGURE, KIND_ROW_IN, KIND_ROW_ACK, KIND_BURST, KIND_RECORDS:
            unknown <= 1'b0;
            KIND_EXPECT, KIND_TRAP: unknown <= TRAP == 0;
            default: unknown <= 1'b1;
        endcase
    end

    wire unused = &{1'b0, fields[39:16], fields[8]};
endmodule

`default_nettype wire
