// The sensor's side of the core: turns FRAME_VALID, LINE_VALID and data into rows, and has each row's step prepared
// in the blanking in front of it. A frame is taken from its beginning or not at all.
`default_nettype none

module halfrow_camera_input #(
    parameter ROW_BITS = 11
) (
    input  wire                clk,         // PIXCLK
    input  wire                rst,
    input  wire [11:0]         height,      // rows behind it are not passed on
    input  wire                bank,        // of the tables that rows use

    input  wire                camera_frame_valid,
    input  wire                camera_line_valid,
    input  wire [11:0]         camera_data,

    output wire                prepare,
    output wire [ROW_BITS-1:0] prepare_row,
    output wire                prepare_bank,
    input  wire                prepared,
    output wire                in_valid,
    output wire                in_start,
    output wire [11:0]         in_sample,

    output wire                frame_valid, // FRAME_VALID of the frames that are taken
    output reg                 row_missed   // one clock: a row began before its step was ready, and was left out
);
    reg armed; // FRAME_VALID has been low, so what rises now is a frame's beginning
    reg frame_before, line_before;

    assign frame_valid = armed && camera_frame_valid;

    always @(posedge clk)
        if (rst) begin
            armed <= 1'b0;
            frame_before <= 1'b0;
        end else begin
            armed <= armed || !camera_frame_valid;
            frame_before <= frame_valid;
        end

    always @(posedge clk)
        line_before <= camera_line_valid;

    reg [11:0] row;        // that starts next
    reg [11:0] rows_there; // from it on
    reg asked;             // the core was told so
    wire row_there = rows_there != 12'd0;
    wire line_start = frame_valid && camera_line_valid && !line_before && row_there;

    assign prepare = !asked && row_there;
    assign prepare_row = row[ROW_BITS-1:0];
    assign prepare_bank = bank;

    always @(posedge clk)
        if (rst || (frame_before && !frame_valid)) begin
            row <= 12'd0;
            rows_there <= height;
            asked <= 1'b0;
        end else if (line_start) begin
            row <= row + 12'd1;
            rows_there <= rows_there - 12'd1;
            asked <= 1'b0;
        end else if (prepare)
            asked <= 1'b1;

    reg taking;

    assign in_start = line_start && asked && prepared;
    assign in_valid = in_start || (taking && frame_valid && camera_line_valid);
    assign in_sample = camera_data;

    always @(posedge clk)
        if (rst) begin
            taking <= 1'b0;
            row_missed <= 1'b0;
        end else begin
            taking <= in_valid;
            row_missed <= line_start && !in_start;
        end
endmodule

`default_nettype wire
