// The ULX3S behind its FT231X, a UART of 3 Mbaud. Neither side can hold the other: the chip's CTS# is on the FPGA's TDO, so the host must
// do without flow control, and the chip's RTS#, which would hold the board's transmitter, is then a constant.
// halfrow_build.vh, which the build script writes, defines HALFROW_BUILD, HALFROW_SERIAL and, for a board with a sensor, HALFROW_SENSOR.
`default_nettype none
`include "halfrow_build.vh"

module ulx3s_uart #(
    parameter TAPS = 7                         // 5 or 7
) (
    input  wire        clk_25mhz,
    input  wire        ftdi_txd,               // TXD of the FT231X
    output wire        ftdi_rxd,               // its RXD
    input  wire        ftdi_nrts,              // its RTS#
    input  wire        wifi_gpio0,             // of the ESP32, whose pins rest high by the FPGA's pull-ups (common.lpf)
    input  wire        wifi_en,
    output wire [7:0]  led
    `include "sensor_ports.vh"
);
    wire oscillator = clk_25mhz;
    `include "board_top.vh"

    wire rts_n;
    wire unused_rts_n = &{1'b0, rts_n};
    wire unused_wifi = &{1'b0, wifi_gpio0, wifi_en};

    halfrow_uart_bridge #(
        .DIVIDER(32),                          // 3 Mbaud of 96 MHz
        .POWER_UP_WIDTH(1920),
        .POWER_UP_HEIGHT(1080),
        .TAPS(TAPS),
        .GRID(1),
        .BUILD(`HALFROW_BUILD),
        .NAME("ULX3S UART")
    ) bridge (
        .link_clk(link_clk), .link_rst(link_rst),
        .rxd(ftdi_txd), .txd(ftdi_rxd), .rts_n(rts_n), .cts_n(ftdi_nrts),
        .clk(clk), .rst(rst), .millisecond(millisecond), .clock_source(clock_source), .clock_hz(clock_hz),
        .serial(serial),
        .camera_frame_valid(taken_frame_valid), .camera_line_valid(taken_line_valid), .camera_data(taken_data),
        .isp_frame_valid(made_frame_valid), .isp_line_valid(made_line_valid), .isp_data(made_data),
        .camera_fault(camera_fault), .session_open(session_open), .packet_seen(packet_seen), .quiet(quiet));
endmodule

`default_nettype wire
