// The first eight bytes of the places of all rows between credit and acknowledgement, as they came: row sequence
// number, frame, row. Whoever needs one reads it byte by byte.
`default_nettype none

module halfrow_row_places #(
    parameter ENTRY_BITS = 2 // row r lies at r mod 2 ** ENTRY_BITS
) (
    input  wire                  clk,
    input  wire                  write,
    input  wire [ENTRY_BITS+2:0] write_address, // {entry, byte}
    input  wire [7:0]            write_byte,
    input  wire [ENTRY_BITS+2:0] check_address,
    output wire [7:0]            check_byte,
    input  wire [ENTRY_BITS+2:0] prepare_address,
    output wire [7:0]            prepare_byte,
    input  wire [ENTRY_BITS+2:0] send_address,
    output wire [7:0]            send_byte
);
    (* ram_style = "distributed" *) reg [7:0] bytes [0:(8<<ENTRY_BITS)-1];

    always @(posedge clk)
        if (write)
            bytes[write_address] <= write_byte;

    assign check_byte = bytes[check_address];
    assign prepare_byte = bytes[prepare_address];
    assign send_byte = bytes[send_address];
endmodule

`default_nettype wire
