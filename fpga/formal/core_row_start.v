// In place of fpga/rtl's, whose product is too much for a solver: position and step are those at the table's port, and every
// row is prepared.
`default_nettype none

module halfrow_row_start #(
    parameter MAX_HEIGHT = 2048,
    parameter ROW_BITS = 37,
    parameter TABLE_BANKS = 1
) (
    input  wire                clk,
    input  wire                rst,
    input  wire [12:0]         centre2,
    input  wire                prepare,
    input  wire [ROW_BITS-1:0] prepare_row,
    input  wire                prepare_bank,
    output wire                prepared,
    input  wire                row_entered,
    input  wire                in_use,
    output wire                row_unprepared,
    output wire [24:0]         step,
    output wire                bank,
    output wire [36:0]         position,
    input  wire                step_write,
    input  wire                table_read,
    input  wire                table_bank,
    input  wire [ROW_BITS-1:0] table_entry,
    input  wire [24:0]         table_data
);
    assign step = table_data;
    assign position = table_entry;
    assign bank = 1'b0;
    assign prepared = 1'b1;
    assign row_unprepared = 1'b0;
endmodule

`default_nettype wire
