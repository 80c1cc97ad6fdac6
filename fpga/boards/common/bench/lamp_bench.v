// Lamp 0 of a board: dark while the PLL has no lock, although its clock runs; then it blinks; and it is dark again when the lock is lost. A
// millisecond is four clocks here.
`timescale 1ns / 1ps
`default_nettype none

module lamp_bench;
    reg         oscillator = 0, locked = 0;
    wire        link_clk, link_rst, clk, rst, millisecond, camera_frame_valid, camera_line_valid, isp_pixclk, isp_frame_valid, isp_line_valid;
    wire [7:0]  clock_source, lamps;
    wire [31:0] clock_hz;
    wire [63:0] serial;
    wire [11:0] camera_data, isp_data;
    integer     clocks = 0, changes = 0;

    always #5.208 oscillator = !oscillator;

    board dut (
        .oscillator(oscillator), .link_clk(link_clk), .link_rst(link_rst), .clk(clk), .rst(rst), .millisecond(millisecond),
        .clock_source(clock_source), .clock_hz(clock_hz), .serial(serial),
        .session_open(1'b0), .packet_seen(1'b0), .camera_fault(1'b0), .lamps(lamps),
        .pin_pixclk(1'b0), .pin_frame_valid(1'b0), .pin_line_valid(1'b0), .pin_data(12'd0),
        .camera_frame_valid(camera_frame_valid), .camera_line_valid(camera_line_valid), .camera_data(camera_data),
        .isp_frame_valid(1'b0), .isp_line_valid(1'b0), .isp_data(12'd0),
        .pin_isp_pixclk(isp_pixclk), .pin_isp_frame_valid(isp_frame_valid), .pin_isp_line_valid(isp_line_valid),
        .pin_isp_data(isp_data));
    defparam dut.milliseconds.LINK_KHZ = 17'd4;

    initial force dut.locked = locked;
    always @(posedge link_clk) clocks = clocks + 1;
    always @(lamps[0]) if ($realtime > 100) changes = changes + 1;

    // Lamp 0 changes each 512 milliseconds, 21 us here.
    task watch(input [8*48-1:0] what, input integer least, input integer most);
        begin
            clocks = 0;
            changes = 0;
            #200000;
            if (clocks > 19000 && changes >= least && changes <= most) $display("PASS %0s", what);
            else $display("FAIL %0s: lamp 0 changed %0d times in %0d clocks", what, changes, clocks);
        end
    endtask

    initial begin
        #100 watch("dark without the PLL's lock", 0, 0);
        locked = 1;
        #45000;                                   // the board's number is read
        watch("blinks with it", 8, 10);
        locked = 0;
        #1000 watch("dark when the lock is lost", 0, 0);
        if (lamps[0] !== 1'b0) $display("FAIL lamp 0 stays lit");
        $display("DONE");
        $finish;
    end
endmodule

`default_nettype wire
