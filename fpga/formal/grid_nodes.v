// halfrow_grid_start at the full pixel clock, segments of 32 columns and rows at least one of them long, whatever is prepared
// meanwhile: what a segment hands over to the next is there when its last column but one comes, and nothing that was found for the row
// in front is taken for it.
`default_nettype none

module grid_nodes #(
    parameter SEGMENT = 32,
    parameter LEAST = 21 // clocks from a request until what it gives can be there
) (
    input wire       clk,
    input wire       wants_prepare,
    input wire       wants_leave,
    input wire       in_use,
    input wire       row_entered,
    input wire [3:0] shape
);
    reg running = 1'b0;
    always @(posedge clk) running <= 1'b1;
    wire rst = !running;

    reg [5:0] column = 6'd0; // of the row that leaves, in its segment, from 1 on
    reg long = 1'b1;         // it has had a segment's columns
    reg grid = 1'b0;         // it has a grid
    reg answered = 1'b0;     // and what it needs next has come
    reg [5:0] since = 6'd0;  // clocks since that was asked for
    wire has_grid, answers;
    wire leave = running && wants_leave && long;
    wire last_but_one = grid && column == SEGMENT[5:0] - 6'd1;
    wire ask_next = last_but_one && !leave;

    halfrow_grid_start dut (
        .clk(clk), .rst(rst), .prepare(wants_prepare && running), .prepare_shape(shape), .row_entered(row_entered),
        .in_use(in_use), .leave(leave), .ask_next(ask_next), .step_write(1'b0), .table_read(1'b0), .has_grid(has_grid),
        .\slopes.is_twice (answers));

    always @(posedge clk)
        if (rst) begin
            {column, since, grid, answered} <= 14'd0;
            long <= 1'b1;
        end else if (leave) begin
            column <= 6'd1;
            since <= 6'd0;
            {long, grid, answered} <= {1'b0, has_grid, 1'b0};
        end else begin
            column <= column == SEGMENT[5:0] ? 6'd1 : column + 6'd1;
            long <= long || column == SEGMENT[5:0];
            since <= ask_next ? 6'd0 : since + {5'd0, since != 6'd63};
            answered <= (answered || answers) && !ask_next;
        end

    always @(posedge clk)
        if (running) begin
            assert (!last_but_one || answered);
            assert (!answers || (grid && !answered && (since >= LEAST[5:0])));
        end
endmodule

`default_nettype wire
