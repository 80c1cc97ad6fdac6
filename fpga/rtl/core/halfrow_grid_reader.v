// Which entries of the grid are read when: of the row that is prepared its offset and the factors at nodes 0 and 1,
// of the row that leaves the factor at a further node whenever one is asked for, which goes first. A column of the
// grid gives three entries one behind the other; from the third to the next column's first it is
// floor((H - 1) / 2^v) + 1. Of a row without a grid, v = 0, one entry is read.
`default_nettype none

module halfrow_grid_reader #(
    parameter ROW_BITS = 11,
    parameter ENTRY_BITS = 11
) (
    input  wire                  clk,
    input  wire                  rst,
    input  wire [10:0]           last_row,       // H - 1

    input  wire                  begin_row,      // pulse: such a row is prepared
    input  wire [ROW_BITS-1:0]   row,
    input  wire                  row_bank,
    input  wire [3:0]            shape,          // {k is 6, v}
    output wire                  bank,           // of the row that is prepared, until it leaves
    output wire                  has_grid,       // its v is not 0
    output wire                  long_segments,  // its k is 6
    input  wire                  leave,          // pulse: it leaves
    input  wire                  cancel,         // pulse: it is not wanted any more
    input  wire                  ask_next,       // pulse: the row that leaves needs one more node

    input  wire                  table_read,     // `table_entry` is shown instead; no row is inside
    input  wire                  table_bank,
    input  wire [ENTRY_BITS-1:0] table_entry,
    output wire                  read,           // two clocks in front of the entry
    output reg                   read_bank,
    output reg  [ENTRY_BITS-1:0] read_entry,

    output wire                  shift,          // pulses to halfrow_spline
    output wire                  start,
    output wire [5:0]            t,
    output wire                  start_leaving,  // with start: it is for the row that leaves,
    output wire                  start_prepared, // or for the one that is prepared
    output wire                  plain           // pulse: the entry is the factor of a row without a grid
);
    localparam [1:0] COLUMNS = 2'd3; // of a row that is prepared: offset, node 0, node 1

    // Of either row: where its next column begins, how far the one behind it lies, the fraction t.
    reg [ENTRY_BITS-1:0] prepared_entry, leaving_entry;
    reg [10:0] prepared_stride;
    reg [9:0] leaving_stride;
    reg [5:0] prepared_t, leaving_t;
    reg prepared_bank, leaving_bank, prepared_grid, prepared_long;

    reg [2:0] shifts;  // by which the row's number becomes b and t
    reg [1:0] unread;  // columns
    reg ask_leaving;
    reg [6:0] phase;   // bit i: so many clocks and one since a column's turn came
    reg busy;          // fewer than eight
    reg for_leaving, for_prepared;
    wire ask_prepared = unread != 2'd0 && shifts == 3'd0;
    wire turn = !busy && (ask_leaving || ask_prepared);
    wire back = phase[3]; // read_entry is where the next column begins
    wire [31:0] number = {{32-ROW_BITS{1'b0}}, row};

    always @(posedge clk)
        if (rst) begin
            phase <= 7'd0;
            busy <= 1'b0;
            ask_leaving <= 1'b0;
            unread <= 2'd0;
            for_leaving <= 1'b0;
            for_prepared <= 1'b0;
        end else begin
            phase <= {phase[5:0], turn};
            busy <= turn || (busy && !phase[6]);
            ask_leaving <= leave ? prepared_grid : ask_next || (ask_leaving && busy);
            if (begin_row)
                unread <= shape[2:0] == 3'd0 ? 2'd1 : COLUMNS;
            else if (cancel)
                unread <= 2'd0;
            else if (turn && !ask_leaving)
                unread <= unread - 2'd1;
            for_leaving <= (turn ? ask_leaving : for_leaving) && !leave;
            for_prepared <= (turn ? !ask_leaving : for_prepared) && !cancel;
        end

    always @(posedge clk)
        if (begin_row) begin
            shifts <= shape[2:0];
            {prepared_long, prepared_grid} <= {shape[3], shape[2:0] != 3'd0};
            prepared_bank <= row_bank;
            prepared_entry <= number[ENTRY_BITS-1:0];
            prepared_t <= 6'd0;
            prepared_stride <= last_row;
        end else if (shifts != 3'd0) begin
            shifts <= shifts - 3'd1;
            {prepared_entry, prepared_t} <= {1'b0, prepared_entry, prepared_t[5:1]};
            prepared_stride <= {1'b0, prepared_stride[10:1]};
        end else if (back && for_prepared)
            prepared_entry <= read_entry;

    always @(posedge clk)
        if (leave) begin
            leaving_entry <= prepared_entry;
            leaving_stride <= prepared_stride[9:0];
            leaving_t <= prepared_t;
            leaving_bank <= prepared_bank;
        end else if (back && for_leaving)
            leaving_entry <= read_entry;

    wire [9:0] stride = (for_leaving ? leaving_stride : prepared_stride[9:0]) & {10{phase[2]}};
    wire [ENTRY_BITS:0] further = {read_entry, 1'b1} + {{ENTRY_BITS-10{1'b0}}, stride, 1'b1};

    always @(posedge clk)
        if (table_read) begin
            read_entry <= table_entry;
            read_bank <= table_bank;
        end else if (!busy) begin
            read_entry <= ask_leaving ? leaving_entry : prepared_entry;
            read_bank <= ask_leaving ? leaving_bank : prepared_bank;
        end else
            read_entry <= further[ENTRY_BITS:1];

    assign bank = prepared_bank;
    assign has_grid = prepared_grid;
    assign long_segments = prepared_long;
    assign read = table_read || |phase[2:0];
    assign plain = phase[2] && for_prepared && !prepared_grid;
    assign shift = phase[2] || phase[3];
    assign start = phase[4];
    assign t = for_leaving ? leaving_t : prepared_t;
    assign start_leaving = start && for_leaving;
    assign start_prepared = start && for_prepared && prepared_grid;
    wire unused = &{1'b0, number[31:ENTRY_BITS], further[0]};
endmodule

`default_nettype wire
