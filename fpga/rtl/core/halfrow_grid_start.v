// What halfrow_row_start is to a core without grids: the table, and of the row that is prepared O and Q[0], which
// make S[0], and G[0]; besides, of the row that leaves, each further G in time. S[0] / 8 =
// C * (2^24 - Q[0]) + 2^12 * O comes by shift and add, a bit of C a clock, with the rounding of 2^11 to a kernel
// position already in it.
`default_nettype none

module halfrow_grid_start #(
    parameter ENTRY_BITS = 11, // T = 2 ** ENTRY_BITS
    parameter ROW_BITS = 11,
    parameter TABLE_BANKS = 2
) (
    input  wire                  clk,
    input  wire                  rst,
    input  wire [10:0]           last_row,      // H - 1
    input  wire [12:0]           centre2,

    input  wire                  prepare,
    input  wire [ROW_BITS-1:0]   prepare_row,
    input  wire                  prepare_bank,
    input  wire [3:0]            prepare_shape, // {k is 6, v}
    output reg                   prepared,
    input  wire                  row_entered,   // the prepared row takes its first sample
    input  wire                  in_use,        // a row has entered that still needs what was prepared
    output reg                   row_unprepared,
    input  wire                  leave,         // pulse: it begins to leave, and what was prepared is taken
    input  wire                  ask_next,      // pulse: the row that leaves has taken next_slope and hand_over

    output wire                  bank,
    output wire                  has_grid,
    output wire                  long_segments, // k is 6
    output reg  [36:0]           position,      // S[0] / 8 + 2^11
    output wire [24:0]           factor,        // Q[0]
    output wire signed [23:0]    first_slope,   // G[0]
    output wire signed [23:0]    next_slope,    // of the row that leaves: G[s + 1],
    output wire signed [23:0]    hand_over,     // G[s] + G[s + 1]

    input  wire                  step_write,
    input  wire                  table_read,
    input  wire                  table_bank,
    input  wire [ENTRY_BITS-1:0] table_entry,
    input  wire [24:0]           table_data,
    output wire [24:0]           step
);
    reg [ROW_BITS-1:0] row;
    reg row_bank;
    reg [3:0] shape;
    reg wanted;
    wire begin_row = wanted && !in_use && !row_entered;

    always @(posedge clk)
        if (prepare)
            {row, row_bank, shape} <= {prepare_row, prepare_bank, prepare_shape};

    wire read, read_bank, shift, start, start_leaving, start_prepared, plain, unused_bank;
    wire [ENTRY_BITS-1:0] read_entry;
    wire [5:0] t;

    halfrow_grid_reader #(.ROW_BITS(ROW_BITS), .ENTRY_BITS(ENTRY_BITS)) reader (
        .clk(clk), .rst(rst), .last_row(last_row), .begin_row(begin_row), .row(row), .row_bank(row_bank), .shape(shape),
        .bank(bank), .has_grid(has_grid), .long_segments(long_segments), .leave(leave), .cancel(prepare),
        .ask_next(ask_next), .table_read(table_read), .table_bank(table_bank), .table_entry(table_entry),
        .read(read), .read_bank(read_bank), .read_entry(read_entry), .shift(shift), .start(start), .t(t),
        .start_leaving(start_leaving), .start_prepared(start_prepared), .plain(plain));

    halfrow_steps #(.MAX_HEIGHT(1 << ENTRY_BITS), .ROW_BITS(ENTRY_BITS), .TABLE_BANKS(TABLE_BANKS)) steps (
        .clk(clk), .write(step_write), .write_bank(table_bank), .write_row(table_entry), .write_step(table_data),
        .read(read), .read_bank(read_bank), .read_row(read_entry), .step(step), .bank(unused_bank));

    wire half, done;
    wire [24:0] value;

    halfrow_spline spline (
        .clk(clk), .rst(rst), .entry(step), .shift(shift), .start(start), .t(t), .half(half), .done(done),
        .value(value));

    // What the spline is at work on, in either half of it.
    reg half_leaving, half_prepared, done_leaving, done_prepared;
    reg [1:0] found; // columns of the row that is prepared
    wire offset = done && done_prepared && found == 2'd0;
    wire node_0 = done && done_prepared && found == 2'd1;

    always @(posedge clk)
        if (rst) begin
            half_leaving <= 1'b0;
            half_prepared <= 1'b0;
            done_leaving <= 1'b0;
            done_prepared <= 1'b0;
        end else begin
            half_leaving <= (start ? start_leaving : half_leaving) && !leave;
            half_prepared <= (start ? start_prepared : half_prepared) && !prepare;
            done_leaving <= (half ? half_leaving : done_leaving) && !leave;
            done_prepared <= (half ? half_prepared : done_prepared) && !prepare;
        end

    always @(posedge clk)
        if (begin_row)
            found <= 2'd0;
        else if (done && done_prepared)
            found <= found + 2'd1;

    wire first_sloped;

    halfrow_grid_slopes slopes (
        .clk(clk), .rst(rst), .value(value), .node_0(node_0), .node_1(done && done_prepared && found == 2'd2),
        .node_next(done && done_leaving), .plain(plain), .entry(step), .long_segments(long_segments), .leave(leave),
        .cancel(prepare), .factor(factor), .first_slope(first_slope), .sloped(first_sloped), .next_slope(next_slope),
        .hand_over(hand_over));

    reg multiply, multiplying, multiplied, sloped; // multiply: the factor comes with the next clock
    reg [3:0] next_bit;
    reg centre_bit; // C from its top bit down, one of them a clock
    reg half_unit;  // the lowest bit of O
    wire begins = plain || multiply;
    wire first_bit = next_bit == 4'd11;
    wire second_bit = next_bit == 4'd10;
    wire last_bit = next_bit == 4'd15;

    always @(posedge clk) begin
        next_bit <= begins || multiplying ? next_bit - 4'd1 : 4'd12;
        centre_bit <= centre2[next_bit];
        if (offset || plain)
            half_unit <= offset && value[0];
    end

    // Thirteen doublings make C * 2^24 of C * 2^11, 2^12 * O of O / 2, whose last bit enters with the first of them,
    // and 2^11 of the one that enters with the second. O is the offset without 2^24.
    wire [24:0] beside_centre = plain ? 25'd0 : {!value[24], value[23:0]};
    wire [12:0] high = centre2 + beside_centre[24:12];
    wire [24:0] subtrahend = centre_bit ? factor : 25'd0;

    always @(posedge clk)
        if (offset || plain)
            position <= {13'd0, high, beside_centre[11:1]};
        else if (multiplying)
            position <= {position[35:0], (first_bit && half_unit) || second_bit} - {12'd0, subtrahend};

    always @(posedge clk)
        if (rst) begin
            wanted <= 1'b0;
            multiply <= 1'b0;
            multiplying <= 1'b0;
            multiplied <= 1'b0;
            sloped <= 1'b0;
            prepared <= 1'b0;
            row_unprepared <= 1'b0;
        end else begin
            wanted <= prepare || (wanted && !begin_row);
            multiply <= node_0 && !prepare;
            multiplying <= (begins || (multiplying && !last_bit)) && !prepare;
            multiplied <= ((multiplying && last_bit) || multiplied) && !row_entered && !prepare;
            sloped <= (first_sloped || sloped) && !row_entered && !prepare;
            prepared <= ((multiplied && sloped) || prepared) && !row_entered && !prepare;
            row_unprepared <= row_entered && !prepared;
        end

    wire unused = &{1'b0, unused_bank, beside_centre[0]};
endmodule

`default_nettype wire
