// What all bitstreams have in common: clocks, resets, the board's number, the sensor's pins and the lamps. The tops add the bridge
// and the pins of its link. board_clocks, board_serial and board_clock_out are each board's own, with its vendor's cells.
`default_nettype none

module board #(
    parameter SENSOR = 0
) (
    input  wire        oscillator,             // pin

    output wire        link_clk,               // 96 MHz
    output wire        link_rst,
    output wire        clk,                    // the core's
    output wire        rst,
    output wire        millisecond,
    output wire [7:0]  clock_source,
    output wire [31:0] clock_hz,
    output wire [63:0] serial,

    input  wire        session_open,           // what the bridge tells the lamps and the choice of the clock, in clk
    input  wire        packet_seen,
    input  wire        camera_fault,
    output wire [7:0]  lamps,                  // pins

    input  wire        pin_pixclk,             // the rest is not looked at without a sensor
    input  wire        pin_frame_valid,
    input  wire        pin_line_valid,
    input  wire [11:0] pin_data,
    output wire        camera_frame_valid,
    output wire        camera_line_valid,
    output wire [11:0] camera_data,
    input  wire        isp_frame_valid,
    input  wire        isp_line_valid,
    input  wire [11:0] isp_data,
    output wire        pin_isp_pixclk,
    output wire        pin_isp_frame_valid,
    output wire        pin_isp_line_valid,
    output wire [11:0] pin_isp_data
);
    `include "halfrow_wire.vh"

    localparam [31:0] LINK_HZ = 32'd96000000;
    localparam [16:0] LINK_KHZ = 17'd96000;

    (* KEEP = "TRUE" *) wire choose_pixclk;    // named in the constraints of a board with a sensor
    wire locked, pixclk_direct, hold, pixclk_alive, link_millisecond, number_ready, pixclk_runs;

    board_clocks #(.SENSOR(SENSOR)) clocks (
        .oscillator(oscillator), .pixclk(pin_pixclk), .choose_pixclk(choose_pixclk), .link_clk(link_clk), .locked(locked),
        .pixclk_direct(pixclk_direct), .clk(clk));

    // Both ends of the queues between the clocks are in reset together.
    wire board_rst;
    wire hold_all = board_rst || hold || !number_ready;

    board_reset whole_reset (.clk(link_clk), .hold(!locked), .rst(board_rst));
    board_reset link_reset (.clk(link_clk), .hold(hold_all), .rst(link_rst));
    board_reset core_reset (.clk(clk), .hold(hold_all), .rst(rst));

    board_millisecond #(.LINK_KHZ(LINK_KHZ)) milliseconds (
        .link_clk(link_clk), .link_millisecond(link_millisecond), .clk(clk), .millisecond(millisecond));

    board_serial number (.link_clk(link_clk), .link_rst(board_rst), .serial(serial), .ready(number_ready));

    board_bit runs (.clk(clk), .level(choose_pixclk), .seen(pixclk_runs));

    generate
        if (SENSOR != 0) begin : with_sensor
            wire [16:0] khz;

            board_choice choice (
                .link_clk(link_clk), .link_rst(board_rst), .link_millisecond(link_millisecond), .pixclk(pixclk_direct),
                .session_open(session_open), .choose_pixclk(choose_pixclk), .hold(hold), .alive(pixclk_alive),
                .rate(khz));

            // Both stand still while the core is not in reset. 1000 = 1024 - 16 - 8.
            wire [31:0] wide = {15'd0, khz};
            reg  [31:0] hertz;

            always @(posedge clk)
                hertz <= pixclk_runs ? (wide << 10) - (wide << 4) - (wide << 3) : LINK_HZ;

            assign clock_hz = hertz;
            assign clock_source = pixclk_runs ? CLOCK_PIXCLK : CLOCK_PLL;

            board_sensor sensor (
                .clk(clk), .pixclk_runs(pixclk_runs),
                .pin_frame_valid(pin_frame_valid), .pin_line_valid(pin_line_valid), .pin_data(pin_data),
                .camera_frame_valid(camera_frame_valid), .camera_line_valid(camera_line_valid),
                .camera_data(camera_data),
                .isp_frame_valid(isp_frame_valid), .isp_line_valid(isp_line_valid), .isp_data(isp_data),
                .pin_isp_pixclk(pin_isp_pixclk), .pin_isp_frame_valid(pin_isp_frame_valid),
                .pin_isp_line_valid(pin_isp_line_valid), .pin_isp_data(pin_isp_data));
        end else begin : without_sensor
            wire unused = &{1'b0, pixclk_direct, pin_frame_valid, pin_line_valid, pin_data,
                isp_frame_valid, isp_line_valid, isp_data};

            assign choose_pixclk = 1'b0;
            assign hold = 1'b0;
            assign pixclk_alive = 1'b0;
            assign clock_hz = LINK_HZ;
            assign clock_source = CLOCK_PLL;
            assign camera_frame_valid = 1'b0;
            assign camera_line_valid = 1'b0;
            assign camera_data = 12'd0;
            assign pin_isp_pixclk = 1'b0;
            assign pin_isp_frame_valid = 1'b0;
            assign pin_isp_line_valid = 1'b0;
            assign pin_isp_data = 12'd0;
        end
    endgenerate

    // One that blinks each second says that the clock runs and that nothing holds the link in reset: a PLL's clock runs without its lock.
    reg [9:0] beat = 10'd0;
    wire      packet_lamp, fault_lamp, frame_lamp;

    always @(posedge link_clk)
        if (link_rst)
            beat <= 10'd0;
        else if (link_millisecond)
            beat <= beat + 10'd1;

    board_lamp packets (.clk(clk), .rst(rst), .millisecond(millisecond), .pulse(packet_seen), .lamp(packet_lamp));
    board_lamp faults (.clk(clk), .rst(rst), .millisecond(millisecond), .pulse(camera_fault), .lamp(fault_lamp));
    board_lamp frames (.clk(clk), .rst(rst), .millisecond(millisecond), .pulse(camera_frame_valid), .lamp(frame_lamp));

    assign lamps = {1'b0, fault_lamp, frame_lamp, pixclk_runs, pixclk_alive, session_open, packet_lamp, beat[9]};
endmodule

`default_nettype wire
