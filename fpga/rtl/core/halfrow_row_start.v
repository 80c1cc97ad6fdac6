// The step table and the source coordinate of a row's first column, S[0] = C * (2^24 - Q), made before the row enters.
// S[0] comes by shift and add, a bit of C a clock, with the rounding of 2^11 to a kernel position already in it.
`default_nettype none

module halfrow_row_start #(
    parameter MAX_HEIGHT = 2048,
    parameter ROW_BITS = 11,
    parameter TABLE_BANKS = 2
) (
    input  wire                clk,
    input  wire                rst,
    input  wire [12:0]         centre2,

    input  wire                prepare,
    input  wire [ROW_BITS-1:0] prepare_row,
    input  wire                prepare_bank,
    output reg                 prepared,
    input  wire                row_entered, // the prepared row takes its first sample
    input  wire                in_use,      // a row has entered that still needs `step` and `position`
    output reg                 row_unprepared,

    output wire [24:0]         step,        // Q
    output wire                bank,
    output reg  [36:0]         position,    // S[0] + 2^11

    input  wire                step_write,
    input  wire                table_read,
    input  wire                table_bank,
    input  wire [ROW_BITS-1:0] table_entry,
    input  wire [24:0]         table_data
);
    reg [ROW_BITS-1:0] row;
    reg row_bank;
    reg wanted, fetched, multiplying;
    reg [3:0] next_bit;
    reg centre_bit; // C from its top bit down, one of them a clock

    wire fetch = wanted && !in_use && !row_entered;

    halfrow_steps #(.MAX_HEIGHT(MAX_HEIGHT), .ROW_BITS(ROW_BITS), .TABLE_BANKS(TABLE_BANKS)) steps (
        .clk(clk), .write(step_write), .write_bank(table_bank), .write_row(table_entry), .write_step(table_data),
        .read(fetch || table_read), .read_bank(row_bank), .read_row(row), .step(step), .bank(bank));

    always @(posedge clk)
        if (prepare || table_read) begin
            row <= prepare ? prepare_row : table_entry;
            row_bank <= prepare ? prepare_bank : table_bank;
        end

    always @(posedge clk) begin
        next_bit <= fetch ? 4'd12 : next_bit - 4'd1;
        centre_bit <= centre2[next_bit];
    end

    wire [24:0] subtrahend = centre_bit ? step : 25'd0;
    wire second_bit = next_bit == 4'd10;
    wire last_bit = next_bit == 4'd15;

    // Thirteen doublings make C * 2^24 of C * 2^11, and 2^11 of the one that enters with the second of them.
    always @(posedge clk)
        if (fetched)
            position <= {13'd0, centre2, 11'd0};
        else if (multiplying)
            position <= {position[35:0], second_bit} - {12'd0, subtrahend};

    always @(posedge clk)
        if (rst) begin
            wanted <= 1'b0;
            fetched <= 1'b0;
            multiplying <= 1'b0;
            prepared <= 1'b0;
            row_unprepared <= 1'b0;
        end else begin
            wanted <= prepare || (wanted && !fetch);
            fetched <= fetch && !prepare;
            multiplying <= (fetched || (multiplying && !last_bit)) && !prepare;
            prepared <= ((multiplying && last_bit) || (prepared && !row_entered)) && !prepare;
            row_unprepared <= row_entered && !prepared;
        end
endmodule

`default_nettype wire
