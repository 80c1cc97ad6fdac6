// The ULX3S with an FT2232H or FT232H on its headers as asynchronous 245 FIFO.
// halfrow_build.vh, which the build script writes, defines HALFROW_BUILD, HALFROW_SERIAL and, for a board with a sensor, HALFROW_SENSOR.
`default_nettype none
`include "halfrow_build.vh"

module ulx3s_fifo #(
    parameter TAPS = 7                         // 5 or 7
) (
    input  wire        clk_25mhz,
    inout  wire [7:0]  ft_d,
    input  wire        ft_rxf_n,
    input  wire        ft_txe_n,
    output wire        ft_rd_n,
    output wire        ft_wr_n,
    output wire        ft_siwu_n,
    output wire        ftdi_rxd,               // RXD of the FT231X, which rests
    input  wire        wifi_gpio0,             // of the ESP32, whose pins rest high by the FPGA's pull-ups (common.lpf)
    input  wire        wifi_en,
    output wire [7:0]  led
    `include "sensor_ports.vh"
);
    wire oscillator = clk_25mhz;
    `include "board_top.vh"

    wire [7:0] ft_data_out;
    wire       ft_data_drive, ft_control_drive, wr_n, siwu_n;

    assign ft_d = ft_data_drive ? ft_data_out : 8'bzzzzzzzz;
    assign ft_wr_n = ft_control_drive ? wr_n : 1'bz;
    assign ft_siwu_n = ft_control_drive ? siwu_n : 1'bz;
    assign ftdi_rxd = 1'b1;
    wire unused_wifi = &{1'b0, wifi_gpio0, wifi_en};

    halfrow_fifo_bridge #(
        .POWER_UP_WIDTH(1920),
        .POWER_UP_HEIGHT(1080),
        .TAPS(TAPS),
        .GRID(1),
        .BUILD(`HALFROW_BUILD),
        .NAME("ULX3S FIFO")
    ) bridge (
        .link_clk(link_clk), .link_rst(link_rst),
        .ft_rxf_n(ft_rxf_n), .ft_txe_n(ft_txe_n), .ft_rd_n(ft_rd_n), .ft_wr_n(wr_n), .ft_siwu_n(siwu_n),
        .ft_control_drive(ft_control_drive), .ft_data_in(ft_d), .ft_data_out(ft_data_out),
        .ft_data_drive(ft_data_drive),
        .clk(clk), .rst(rst), .millisecond(millisecond), .clock_source(clock_source), .clock_hz(clock_hz),
        .serial(serial),
        .camera_frame_valid(taken_frame_valid), .camera_line_valid(taken_line_valid), .camera_data(taken_data),
        .isp_frame_valid(made_frame_valid), .isp_line_valid(made_line_valid), .isp_data(made_data),
        .camera_fault(camera_fault), .session_open(session_open), .packet_seen(packet_seen), .quiet(quiet));
endmodule

`default_nettype wire
