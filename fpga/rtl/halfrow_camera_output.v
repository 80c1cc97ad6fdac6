// The image processor's side of the core: LINE_VALID and data are the core's outputs, and FRAME_VALID is the sensor's, later
// by the same D = W/2 + L pixel clocks. Its two edges are delayed one by one, so a blanking shorter than D comes out whole.
`default_nettype none

module halfrow_camera_output #(
    parameter LATENCY = 12                        // L, at least 2
) (
    input  wire        clk,
    input  wire        rst,
    input  wire [11:0] width,

    input  wire        frame_valid,               // as the core's input sees it
    input  wire        out_valid,
    input  wire [11:0] out_sample,

    output wire        isp_frame_valid,
    output wire        isp_line_valid,
    output wire [11:0] isp_data
);
    localparam [11:0] BEHIND_HALF = LATENCY - 2;

    wire [11:0] delay = {1'b0, width[11:1]} + BEHIND_HALF;
    wire        unused = &{1'b0, width[0]};       // W is even

    reg         frame_before;
    reg         rising, falling;                  // an edge is on its way
    reg  [11:0] until_rise, until_fall;
    reg         frame;

    always @(posedge clk) begin
        until_rise <= (frame_valid && !frame_before) ? delay : until_rise - 12'd1;
        until_fall <= (!frame_valid && frame_before) ? delay : until_fall - 12'd1;
    end

    wire rise = rising && until_rise == 12'd0;
    wire fall = falling && until_fall == 12'd0;

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
