// What stands between a row's place and its samples in a ROW_OUT packet, bytes 8 to 19 of the payload, and as bytes 20
// to 23 what entered, which follows the samples; for each out-bank. The bytes come from three sides and are written one
// by one.
`default_nettype none

module halfrow_row_heads #(
    parameter OUT_BITS = 1
) (
    input  wire                clk,
    input  wire                rst,

    input  wire                start,        // pulse; of the fields that follow all but the bank stay for 8 clocks
    input  wire [OUT_BITS-1:0] start_bank,
    input  wire [11:0]         width,
    input  wire                start_is_last,
    input  wire [7:0]          start_generation,

    input  wire                left,         // pulse; the fields that follow stay for 16 clocks
    input  wire [OUT_BITS-1:0] left_bank,
    input  wire [15:0]         first_latency,
    input  wire [15:0]         last_latency,
    input  wire [15:0]         pauses,
    input  wire [31:0]         entered,

    input  wire [OUT_BITS-1:0] bank,
    input  wire [3:0]          index,        // byte 8 to 23, modulo 16
    output wire [7:0]          value,
    input  wire                replace,      // pulse: replacement becomes byte 18 or 19 of that bank
    input  wire                replace_high, // byte 19
    input  wire [7:0]          replacement
);
    (* ram_style = "distributed" *) reg [7:0] bytes [0:(16<<OUT_BITS)-1];

    reg start_due, left_due;
    reg [1:0] start_place;
    reg [3:0] left_place; // places 6 and 7 are those of the replacements, which come later
    reg [OUT_BITS-1:0] started_bank;

    wire [7:0] width_byte = start_place[0] ? {4'd0, width[11:8]} : width[7:0];
    wire [7:0] name_byte = start_place[0] ? start_generation : {7'd0, start_is_last};
    // Kept, because the mapper would trade look-up tables for depth.
    (* keep = "true" *) wire [7:0] start_byte;
    assign start_byte = start_place[1] ? name_byte : width_byte;
    wire [7:0] first_byte = left_place[0] ? first_latency[15:8] : first_latency[7:0];
    wire [7:0] last_byte = left_place[0] ? last_latency[15:8] : last_latency[7:0];
    wire [7:0] pauses_byte = left_place[0] ? pauses[15:8] : pauses[7:0];
    (* keep = "true" *) wire [7:0] left_byte;
    assign left_byte = left_place[2] ? pauses_byte : left_place[1] ? last_byte : first_byte;
    wire [7:0] went_byte = left_place[3] ? entered[{left_place[1:0], 3'd0} +: 8] : left_byte;

    wire [OUT_BITS+3:0] started_at = {started_bank, 2'b10, start_place};
    wire [OUT_BITS+3:0] left_at = {left_bank, left_place[3:2] == 2'd0, !left_place[2], left_place[1:0]};
    wire [OUT_BITS+3:0] replaced_at = {bank, 3'b001, replace_high};
    wire [OUT_BITS+3:0] address = replace ? replaced_at : start_due ? started_at : left_at;

    assign value = bytes[{bank, index}];

    reg write;
    reg [OUT_BITS+3:0] write_address;
    reg [7:0] write_byte;

    always @(posedge clk) begin
        write <= replace || start_due || left_due;
        write_address <= address;
        write_byte <= replace ? replacement : start_due ? start_byte : went_byte;
        if (write)
            bytes[write_address] <= write_byte;
    end

    always @(posedge clk) begin
        if (start) begin
            started_bank <= start_bank;
            start_place <= 2'd0;
        end else if (start_due && !replace)
            start_place <= start_place + 2'd1;
        if (left)
            left_place <= 4'd0;
        else if (left_due && !start_due && !replace)
            left_place <= left_place + 4'd1;
        start_due <= !rst && (start || (start_due && (replace || start_place != 2'd3)));
        left_due <= !rst && (left || (left_due && (start_due || replace || left_place != 4'd11)));
    end
endmodule

`default_nettype wire
