// The sensor's and the image processor's pins, each with a register at the pin. With the register behind the sensor's and the one
// in front of the image processor's a picture is W/2 + L + 2 clocks late from pins to pins.
`default_nettype none

module board_sensor #(
    parameter CAPTURE_FALLING = 1              // 1: the sensor's data are taken with the falling edge of PIXCLK, 0: the rising one
) (
    input  wire        clk,
    input  wire        pixclk_runs,            // clk is PIXCLK; otherwise the sensor's pins mean nothing

    input  wire        pin_frame_valid,
    input  wire        pin_line_valid,
    input  wire [11:0] pin_data,
    output reg         camera_frame_valid,
    output reg         camera_line_valid,
    output reg  [11:0] camera_data,

    input  wire        isp_frame_valid,
    input  wire        isp_line_valid,
    input  wire [11:0] isp_data,
    output wire        pin_isp_pixclk,         // its falling edge is in the middle of the data
    output reg         pin_isp_frame_valid,
    output reg         pin_isp_line_valid,
    output reg  [11:0] pin_isp_data
);
    (* IOB = "TRUE" *) reg [13:0] caught;

    generate
        if (CAPTURE_FALLING != 0) begin : falling
            always @(negedge clk)
                caught <= {pin_frame_valid, pin_line_valid, pin_data};
        end else begin : rising
            always @(posedge clk)
                caught <= {pin_frame_valid, pin_line_valid, pin_data};
        end
    endgenerate

    always @(posedge clk) begin
        {camera_frame_valid, camera_line_valid} <= caught[13:12] & {2{pixclk_runs}};
        camera_data <= caught[11:0];
        pin_isp_frame_valid <= isp_frame_valid;
        pin_isp_line_valid <= isp_line_valid;
        pin_isp_data <= isp_data;
    end

    board_clock_out isp_clock (.clk(clk), .pin(pin_isp_pixclk));
endmodule

`default_nettype wire
