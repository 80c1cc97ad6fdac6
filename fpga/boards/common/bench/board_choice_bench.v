// The choice of the core's clock while a sensor comes, goes and comes back: the core must be in reset around each change, never
// see a pulse shorter than half a period outside of it, and always have a clock again. A millisecond is 10 us here, and a quarter of it
// where the sensor goes many times.
`timescale 1ns / 1ps
`default_nettype none

module board_choice_bench;
    localparam real LINK_HALF = 5.208, PIXEL_HALF = 6.73;

    reg        link_clk = 0, pixclk = 0, pixclk_runs = 0, session_open = 0, rst_pin = 1;
    reg  [9:0] count = 0;
    wire       choose_pixclk, hold, alive, clk, link_rst, rst;
    wire [16:0] rate;
    reg  [9:0] last = 959;                        // link clocks of a millisecond, less one
    wire       link_millisecond = count == last;

    always #LINK_HALF link_clk = !link_clk;
    always begin
        #PIXEL_HALF;
        if (pixclk_runs) pixclk = !pixclk;
    end
    always @(posedge link_clk) count <= link_millisecond ? 10'd0 : count + 10'd1;

    board_reset link_reset (.clk(link_clk), .hold(rst_pin), .rst(link_rst));
    board_reset core_reset (.clk(clk), .hold(link_rst || hold), .rst(rst));
    board_choice #(.LEAST_KHZ(40), .MOST_KHZ(1000)) choice (
        .link_clk(link_clk), .link_rst(link_rst), .link_millisecond(link_millisecond), .pixclk(pixclk),
        .session_open(session_open), .choose_pixclk(choose_pixclk), .hold(hold), .alive(alive), .rate(rate));
    BUFGMUX #(.CLK_SEL_TYPE("ASYNC")) core_buffer (.I0(link_clk), .I1(pixclk), .S(choose_pixclk), .O(clk));

    // Nothing outside of reset may see a short pulse, and a reset must last some clocks on both sides of a change.
    real    edge_time = 0;
    integer short_pulses = 0, bare_changes = 0, clocks_in_reset = 0, short_resets = 0;

    always @(clk) begin
        if (!rst && $realtime - edge_time < LINK_HALF - 0.1) short_pulses = short_pulses + 1;
        edge_time = $realtime;
    end
    always @(choose_pixclk) if (!rst && !rst_pin) bare_changes = bare_changes + 1;
    always @(posedge clk) if (rst) clocks_in_reset = clocks_in_reset + 1;
    always @(negedge rst) begin
        if (clocks_in_reset < 16) short_resets = short_resets + 1;
        clocks_in_reset = 0;
    end

    task settle(input [8*64-1:0] what, input from_pixclk, input real microseconds);
        integer before;
        begin
            #(microseconds * 1000.0);
            before = clocks;
            #1000;
            if (choose_pixclk === from_pixclk && !rst && clocks - before > 60 && short_pulses == 0 && bare_changes == 0
                && short_resets == 0) $display("PASS %0s", what);
            else $display("FAIL %0s: PIXCLK %b rst %b, %0d clocks, %0d short pulses, %0d changes without reset", what,
                choose_pixclk, rst, clocks - before, short_pulses, bare_changes);
        end
    endtask

    integer clocks = 0, i;
    always @(posedge clk) clocks = clocks + 1;

    task stop(input level);
        begin
            @(posedge pixclk);
            if (!level) @(negedge pixclk);
            pixclk_runs = 0;
        end
    endtask

    initial begin
        #100 rst_pin = 0;
        settle("without a sensor: the PLL", 0, 100);
        pixclk_runs = 1;
        settle("PIXCLK comes: not before it was steady for two windows", 0, 160);
        settle("PIXCLK comes: chosen", 1, 400);
        if (rate < 741 || rate > 745) $display("FAIL rate %0d of 743", rate); else $display("PASS its rate is known");
        stop(0);
        settle("PIXCLK stops low: the PLL within 8 us", 0, 8);
        pixclk_runs = 1;
        settle("PIXCLK comes back", 1, 600);
        stop(1);
        settle("PIXCLK stops high: the PLL within 8 us", 0, 8);
        session_open = 1;
        pixclk_runs = 1;
        settle("PIXCLK comes back during a session: it waits", 0, 600);
        session_open = 0;
        settle("and is chosen behind it", 1, 5);
        session_open = 1;
        settle("a session goes on with PIXCLK", 1, 400);
        stop(1);
        settle("unless that stops", 0, 8);
        last = 239;
        for (i = 0; i < 20; i = i + 1) begin
            pixclk_runs = 1; session_open = 0;
            #(130000.0 + 37.3 * i);
            if (!choose_pixclk) $display("FAIL PIXCLK was not chosen the %0dth time", i);
            stop(i % 2);
            #(1.7 * i);
        end
        settle("twenty times more, in other phases", 0, 8);
        $display("DONE");
        $finish;
    end
endmodule

`default_nettype wire
