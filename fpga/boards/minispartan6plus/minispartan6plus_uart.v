// The miniSpartan6+ with channel B of its FT2232H as UART, 12 Mbaud with RTS/CTS.
// halfrow_build.vh, which the build script writes, defines HALFROW_BUILD and, for a board with a sensor, HALFROW_SENSOR.
`default_nettype none
`include "halfrow_build.vh"

module minispartan6plus_uart (
    input  wire        clk32,                  // 32 MHz
    input  wire        uart_rxd,               // TXD of the FT2232H
    output wire        uart_txd,               // its RXD
    input  wire        uart_cts_n,             // its RTS#
    output wire        uart_rts_n,             // its CTS#
    output wire [7:0]  led
    `include "sensor_ports.vh"
);
    wire oscillator = clk32;
    `include "board_top.vh"

    halfrow_uart_bridge #(
        .POWER_UP_WIDTH(1920),
        .POWER_UP_HEIGHT(1080),
        .TRAP(0),
        .BUILD(`HALFROW_BUILD),
        .NAME("miniSpartan6+ LX25 UART")
    ) bridge (
        .link_clk(link_clk), .link_rst(link_rst),
        .rxd(uart_rxd), .txd(uart_txd), .rts_n(uart_rts_n), .cts_n(uart_cts_n),
        .clk(clk), .rst(rst), .millisecond(millisecond), .clock_source(clock_source), .clock_hz(clock_hz),
        .serial(serial),
        .camera_frame_valid(taken_frame_valid), .camera_line_valid(taken_line_valid), .camera_data(taken_data),
        .isp_frame_valid(made_frame_valid), .isp_line_valid(made_line_valid), .isp_data(made_data),
        .camera_fault(camera_fault), .session_open(session_open), .packet_seen(packet_seen), .quiet(quiet));
endmodule

`default_nettype wire
