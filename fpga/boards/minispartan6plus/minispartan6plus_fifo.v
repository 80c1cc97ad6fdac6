// The miniSpartan6+ with channel B of its FT2232H as asynchronous 245 FIFO.
// halfrow_build.vh, which the build script writes, defines HALFROW_BUILD and, for a board with a sensor, HALFROW_SENSOR.
`default_nettype none
`include "halfrow_build.vh"

module minispartan6plus_fifo (
    input  wire        clk32,                  // 32 MHz
    inout  wire [7:0]  ft_d,
    input  wire        ft_rxf_n,
    input  wire        ft_txe_n,
    output wire        ft_rd_n,
    output wire        ft_wr_n,
    output wire        ft_siwu_n,
    output wire [7:0]  led
    `include "sensor_ports.vh"
);
    wire oscillator = clk32;
    `include "board_top.vh"

    wire [7:0] ft_data_out;
    wire       ft_data_drive, ft_control_drive, wr_n, siwu_n;

    assign ft_d = ft_data_drive ? ft_data_out : 8'bzzzzzzzz;
    assign ft_wr_n = ft_control_drive ? wr_n : 1'bz;
    assign ft_siwu_n = ft_control_drive ? siwu_n : 1'bz;

    halfrow_fifo_bridge #(
        .POWER_UP_WIDTH(1920),
        .POWER_UP_HEIGHT(1080),
        .TRAP(0),
        .BUILD(`HALFROW_BUILD),
        .NAME("miniSpartan6+ LX25 FIFO")
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
