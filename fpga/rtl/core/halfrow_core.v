// The corrector of fpga/DATAPATH.md: a sample in and a sample out on every pixel clock, W/2 + L pixel clocks apart.
// L is 12 with seven taps and 11 with five; rows may follow each other without a clock between them.
`default_nettype none

module halfrow_core #(
    parameter MAX_HEIGHT = 2048,
    parameter ROW_BITS = 11,
    parameter GRID = 0,              // 1: datapath 2 besides
    parameter ENTRY_BITS = ROW_BITS, // with a grid 11 or 12: T = 2 ** ENTRY_BITS
    parameter RING_BITS = 11,        // M = 2 ** RING_BITS samples, at least as many as the widest row has
    parameter TAPS = 7,              // 5 or 7
    parameter TABLE_BANKS = 2        // 1 or 2
) (
    input  wire                  clk,
    input  wire                  rst,            // empties the core in one clock; the tables keep their contents
    input  wire                  enable,         // the pixel clock enable: while it is low no pixel moves

    input  wire [11:0]           width,          // W, C and B change only while the core is empty
    input  wire [10:0]           last_row,       // H - 1, likewise; without a grid it is not looked at
    input  wire [12:0]           centre2,        // C
    input  wire [1:0]            depth,          // B: 0 for 8 bits, 1 for 10, 2 for 12

    // The row that enters next; not gated by enable.
    input  wire                  prepare,        // one clock; after the start of the row in front
    input  wire [ROW_BITS-1:0]   prepare_row,
    input  wire                  prepare_bank,
    input  wire [3:0]            prepare_shape,  // of the bank: {k is 6, v}
    output wire                  prepared,       // the row may start

    input  wire                  in_valid,
    input  wire                  in_start,       // with the row's first sample
    input  wire [11:0]           in_sample,
    output wire                  out_valid,
    output wire                  out_start,      // with the row's first output
    output wire                  out_last,       // with its last
    output wire [11:0]           out_sample,

    output wire                  row_short,      // one clock: a row ended before its last column
    output wire                  row_long,       // one clock: a row went on behind its last column
    output wire                  row_unprepared, // one clock: a row started while `prepared` was low

    // The tables; not gated by enable. A node is {g6, r5, g4, r1, g0}.
    input  wire                  step_write,
    input  wire                  node_write,
    input  wire                  table_bank,
    input  wire [ENTRY_BITS-1:0] table_entry,
    input  wire [79:0]           table_data,
    input  wire                  table_read,     // the ports show `table_entry` three clocks later; the core is empty
    output wire [24:0]           step_port,
    output wire [79:0]           node_port_0,
    output wire [79:0]           node_port_1
);
    `include "halfrow_wire.vh"
    `include "halfrow_board.vh"

    generate // what a build cannot have
        if (MAX_HEIGHT < 1 || MAX_HEIGHT > GREATEST_HEIGHT) halfrow_illegal_MAX_HEIGHT is_1_to_2048 ();
        if (ROW_BITS < bits_for(MAX_HEIGHT) || ROW_BITS < bits_for(NODES))
            halfrow_illegal_ROW_BITS numbers_rows_and_nodes ();
        if (RING_BITS < 4 || RING_BITS > 15) halfrow_illegal_RING_BITS is_4_to_15 ();
        if (TAPS != 5 && TAPS != 7) halfrow_illegal_TAPS is_5_or_7 ();
        if (TABLE_BANKS != 1 && TABLE_BANKS != 2) halfrow_illegal_TABLE_BANKS is_1_or_2 ();
        if (GRID != 0 && GRID != 1) halfrow_illegal_GRID is_0_or_1 ();
        if (GRID == 0 ? ENTRY_BITS != ROW_BITS : ENTRY_BITS < 11 || ENTRY_BITS > 12)
            halfrow_illegal_ENTRY_BITS is_11_or_12_with_a_grid_and_else_ROW_BITS ();
    endgenerate

    localparam LEFT = (TAPS == 7) ? 3 : 2; // the window is n - LEFT ... n + 4

    wire [RING_BITS-1:0] write_address, first_address, last_address, read_address;
    wire ring_write, ring_read;
    wire [11:0] newest;
    wire row_begin, row_end, start_waits;
    wire [36:0] start_position;
    wire start_bank;
    wire [12*(LEFT+4)-1:0] opening;

    wire row_entered = enable && in_valid && in_start;
    wire start_grid, start_long, ask_next;
    wire signed [23:0] first_slope, next_slope, hand_over;
    wire [24:0] start_step;

    generate
        if (GRID == 1) begin : grid
            halfrow_grid_start #(
                .ENTRY_BITS(ENTRY_BITS), .ROW_BITS(ROW_BITS), .TABLE_BANKS(TABLE_BANKS)
            ) grid_start (
                .clk(clk), .rst(rst), .last_row(last_row), .centre2(centre2),
                .prepare(prepare), .prepare_row(prepare_row), .prepare_bank(prepare_bank),
                .prepare_shape(prepare_shape), .prepared(prepared), .row_entered(row_entered), .in_use(start_waits),
                .row_unprepared(row_unprepared), .leave(row_begin), .ask_next(ask_next),
                .bank(start_bank), .has_grid(start_grid), .long_segments(start_long), .position(start_position),
                .factor(start_step), .first_slope(first_slope), .next_slope(next_slope), .hand_over(hand_over),
                .step_write(step_write), .table_read(table_read), .table_bank(table_bank), .table_entry(table_entry),
                .table_data(table_data[24:0]), .step(step_port));
        end else begin : line
            halfrow_row_start #(
                .MAX_HEIGHT(MAX_HEIGHT), .ROW_BITS(ROW_BITS), .TABLE_BANKS(TABLE_BANKS)
            ) row_start (
                .clk(clk), .rst(rst), .centre2(centre2),
                .prepare(prepare), .prepare_row(prepare_row), .prepare_bank(prepare_bank), .prepared(prepared),
                .row_entered(row_entered), .in_use(start_waits), .row_unprepared(row_unprepared),
                .step(step_port), .bank(start_bank), .position(start_position),
                .step_write(step_write), .table_read(table_read), .table_bank(table_bank), .table_entry(table_entry),
                .table_data(table_data[24:0]));

            assign start_step = step_port;
            assign {start_grid, start_long, first_slope, next_slope, hand_over} = 74'd0;
            wire unused = &{1'b0, last_row, prepare_shape, ask_next};
        end
    endgenerate

    halfrow_entry #(.RING_BITS(RING_BITS), .LEFT(LEFT)) entry (
        .clk(clk), .rst(rst), .enable(enable), .width(width), .first_column(start_position[36:25]),
        .in_valid(in_valid), .in_start(in_start), .in_sample(in_sample),
        .ring_write(ring_write), .write_address(write_address), .first_address(first_address),
        .last_address(last_address), .opening(opening), .row_end(row_end), .row_begin(row_begin), .waiting(start_waits),
        .row_short(row_short), .row_long(row_long));

    halfrow_ring #(.RING_BITS(RING_BITS)) ring (
        .clk(clk), .write(ring_write), .write_address(write_address), .write_sample(in_sample),
        .read(ring_read), .read_address(read_address), .read_sample(newest));

    wire [5:0] node;
    wire [7:0] fraction;
    wire other_colour, load, move, leaving_bank;
    wire made_valid, made_start, made_last;

    halfrow_source #(.RING_BITS(RING_BITS), .GRID(GRID)) source (
        .clk(clk), .rst(rst), .enable(enable), .width(width),
        .row_begin(row_begin), .position(start_position), .step(start_step), .bank(start_bank),
        .has_grid(start_grid), .long_segments(start_long), .first_slope(first_slope), .next_slope(next_slope),
        .hand_over(hand_over), .ask_next(ask_next),
        .first_address(first_address), .row_end(row_end), .last_address(last_address), .read_address(read_address),
        .node(node), .fraction(fraction), .leaving_bank(leaving_bank),
        .load(load), .move(move), .other_colour(other_colour),
        .made_valid(made_valid), .made_start(made_start), .made_last(made_last));

    assign ring_read = enable && (load || move);

    wire [12*7-1:0] taps;
    halfrow_window #(.LEFT(LEFT)) tap_window (
        .clk(clk), .enable(ring_read), .load(load), .opening(opening), .newest(newest),
        .other_colour(other_colour), .taps(taps));

    wire [79:0] weights;
    halfrow_kernel #(.TAPS(TAPS), .TABLE_BANKS(TABLE_BANKS)) kernel_weights (
        .clk(clk), .enable(enable), .bank(leaving_bank), .node(node), .fraction(fraction), .weights(weights),
        .node_write(node_write), .table_read(table_read), .table_bank(table_bank), .table_entry(table_entry[6:0]),
        .table_data(table_data), .node_port_0(node_port_0), .node_port_1(node_port_1));

    halfrow_weigh #(.TAPS(TAPS)) weigh (
        .clk(clk), .rst(rst), .enable(enable), .depth(depth), .taps(taps), .weights(weights),
        .made_valid(made_valid), .made_start(made_start), .made_last(made_last),
        .out_valid(out_valid), .out_start(out_start), .out_last(out_last), .out_sample(out_sample));
endmodule

`default_nettype wire
