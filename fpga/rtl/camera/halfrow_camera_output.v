// The image processor's side of the core: LINE_VALID and data are the core's outputs, and FRAME_VALID is the
// sensor's, later by the same D = W/2 + L pixel clocks. Its two edges are delayed one by one, so a blanking shorter
// than D comes out whole.
`default_nettype none

module halfrow_camera_output #(
    parameter TAPS = 7
) (
    input  wire        clk,
    input  wire        rst,
    input  wire [11:0] width,

    input  wire        frame_valid, // as the core's input sees it
    input  wire        out_valid,
    input  wire [11:0] out_sample,

    output wire        isp_frame_valid,
    output wire        isp_line_valid,
    output wire [11:0] isp_data
);
    `include "halfrow_board.vh"

    localparam BEHIND_HALF = latency_of(TAPS) - 2;

    wire [10:0] delay = width[11:1] + BEHIND_HALF[10:0];
    wire unused = &{1'b0, width[0]}; // W is even

    reg frame_before;
    reg rising, falling; // an edge is on its way
    reg [10:0] since_rise, since_fall;
    reg frame;

    always @(posedge clk) begin
        since_rise <= (frame_valid && !frame_before) ? 11'd0 : since_rise + 11'd1;
        since_fall <= (!frame_valid && frame_before) ? 11'd0 : since_fall + 11'd1;
    end

    wire rise = rising && since_rise == delay;
    wire fall = falling && since_fall == delay;

    always @(posedge clk)
        if (rst) begin
            frame_before <= 1'b0;
            rising <= 1'b0;
            falling <= 1'b0;
            frame <= 1'b0;
        end else begin
            frame_before <= frame_valid;
            rising <= (frame_valid && !frame_before) || (rising && !rise);
            falling <= (!frame_valid && frame_before) || (falling && !fall);
            frame <= rise || (frame && !fall);
        end

    assign isp_frame_valid = frame;
    assign isp_line_valid = frame && out_valid;
    assign isp_data = isp_line_valid ? out_sample : 12'd0;
endmodule

`default_nettype wire
