// A board with a sensor, an image processor and a host's USB chip at its pins; host.vh has the chip and the board. The sensor's
// data are good from 2 ns before the falling edge of PIXCLK to 2 ns behind it, as the miniSpartan6+'s sensor.ucf has it, and unknown
// otherwise; its edges jitter. The image processor takes what is there at the falling edge of its own clock. Pictures of the power-up
// size come through unchanged, W/2 + L + 2 clocks late, from the first whole one on; again behind a PIXCLK that stopped in the middle
// of a picture. A HELLO is answered while the core runs from PIXCLK, and the session that it opens holds pictures back.
//   +rising    the sensor's data are good around the other edge      +inverted   its LINE_VALID is low in a row
//   +late      its data come half a clock too late                   +short      its rows have two samples less
// A millisecond is 2.5 us here, so that the board's choice of the clock takes no 32 ms.
`timescale 1ns / 1ps
`default_nettype none
`define SENSOR_AT_PINS

module sensor_bench;
    localparam real HALF = 5.21, JITTER = 0.25, GOOD = 2.0;
    localparam W = 1920, ROWS = 3, BLANKING = 450, LATENCY = W / 2 + 12 + 2;
    localparam WIPED = 9000;                      // clocks in which the tables are filled, at most

    reg  oscillator = 0, running = 0, pixclk = 0;
    reg  frame_valid = 0, line_valid = 0, rising, inverted, late, short_rows;
    reg  [11:0] data = 0;
    wire isp_pixclk, isp_frame_valid, isp_line_valid;
    wire [11:0] isp_data;
    wire [7:0] led;

    always #5.208 oscillator = !oscillator;       // the PLL's model passes its input on
    always begin
        #(HALF + JITTER * (($random & 255) / 127.5 - 1.0));
        if (running) pixclk = !pixclk;
    end

    // The pins of the sensor as the board sees them.
    reg  seen_frame, seen_line;
    reg  [11:0] seen_data;
    task show;
        begin
            {seen_frame, seen_line, seen_data} = {frame_valid, line_valid ^ inverted, data};
            #(2 * GOOD);
            if (!late) {seen_frame, seen_line, seen_data} = 14'hx;
        end
    endtask
    always @(posedge pixclk) begin
        #(HALF - JITTER - GOOD);
        if (rising) #(HALF + JITTER);
        if (late) #(HALF + GOOD);
        show;
    end

    `include "host.vh"
    defparam dut.board.milliseconds.LINK_KHZ = 17'd240;
    defparam dut.board.with_sensor.choice.LEAST_KHZ = 16'd10;
    defparam dut.board.with_sensor.choice.MOST_KHZ = 17'd250;

    // A sample of a picture; neighbours differ in many bits.
    function [11:0] sample(input integer frame, input integer row, input integer column);
        sample = (column * 1103 + row * 977 + frame * 2719) ^ (column >> 3) ^ (row << 5);
    endfunction

    integer frame = 0, clocks = 0, began = 0, line, j;
    always @(posedge pixclk) clocks = clocks + 1;

    task idle(input integer count);
        repeat (count) @(posedge pixclk);
    endtask

    task picture(input integer stop_in_row);
        begin : shown
            frame = frame + 1;
            frame_valid = 1;
            idle(80);
            for (line = 0; line < ROWS; line = line + 1) begin
                if (line == 0) began = clocks;
                for (j = 0; j < W - (short_rows ? 2 : 0); j = j + 1) begin
                    line_valid = 1;
                    data = sample(frame, line, j);
                    if (line == stop_in_row && j == W / 3) begin
                        running = 0;
                        line_valid = 0;
                        frame_valid = 0;
                        disable shown;
                    end
                    idle(1);
                end
                line_valid = 0;
                idle(BLANKING);
            end
            frame_valid = 0;
            idle(LATENCY + 300);
        end
    endtask

    // The image processor: whole pictures only, each row whole, and every sample that of the sensor.
    integer row = 0, column = 0, wrong = 0, pictures = 0, delay = -1, cut = 0;
    reg     was_frame = 0, was_line = 0;
    always @(negedge isp_pixclk) begin
        if (isp_frame_valid === 1'b1 && !was_frame) row = 0;
        if (isp_line_valid === 1'b1) begin
            if (!was_line) begin
                column = 0;
                if (row == 0) delay = clocks - began;
            end
            if (isp_frame_valid !== 1'b1 || isp_data !== sample(frame, row, column)) wrong = wrong + 1;
            column = column + 1;
        end else if (was_line) begin
            if (column != W) wrong = wrong + 1;
            row = row + 1;
        end
        if (isp_frame_valid !== 1'b1 && was_frame) begin
            if (row == ROWS) pictures = pictures + 1;
            else cut = cut + 1;
        end
        if (running && (isp_line_valid === 1'bx || isp_frame_valid === 1'bx)) wrong = wrong + 1;
        was_frame = isp_frame_valid === 1'b1;
        was_line = isp_line_valid === 1'b1;
    end

    task due(input [8*72-1:0] what, input integer whole, input integer cut_short);
        if (wrong == 0 && pictures == whole && cut == cut_short && delay == LATENCY && led[6] === 1'b0)
            $display("PASS %0s", what);
        else
            $display("FAIL %0s: %0d of %0d pictures, %0d cut, %0d wrong, %0d clocks late, due %0d, lamps %b", what, pictures, whole, cut,
                wrong, delay, LATENCY, led);
    endtask

    // The core runs from PIXCLK, and its tables are filled.
    task chosen;
        begin
            wait (led[4] === 1'b1);
            idle(WIPED);
        end
    endtask

    initial begin
        rising = $test$plusargs("rising");
        inverted = $test$plusargs("inverted");
        late = $test$plusargs("late");
        short_rows = $test$plusargs("short");
        #1000 running = 1;
        chosen;
        picture(-1);
        picture(-1);
        due("pictures come through before any host", 2, 0);
        if (rising || inverted || late || short_rows) $finish;
        picture(1);
        wait (led[4] === 1'b0);
        #5000 running = 1;
        chosen;
        picture(-1);
        due("and again behind a PIXCLK that stopped in a row", 3, 1);
        say_hello;
        picture(-1);
        due("but not during a session", 3, 1);
        $display("DONE");
        $finish;
    end

    initial begin
        #4000000 $display("FAIL the board took four milliseconds");
        $finish;
    end
endmodule

`default_nettype wire
