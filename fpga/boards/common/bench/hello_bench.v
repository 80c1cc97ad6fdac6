// A whole board from pin to pin: a host's HELLO goes in at the USB chip's pins and its answer must come out, with the build and
// the board's number in it. LINK_FIFO chooses the top. The PLL's model passes its input on, so the oscillator runs at 96 MHz here.
`timescale 1ns / 1ps
`default_nettype none

module hello_bench;
    reg        oscillator = 0;
    wire [7:0] led;

    always #5.208 oscillator = !oscillator;

    `include "host.vh"

    initial begin
        #2000000 $display("FAIL the board took two milliseconds");
        $finish;
    end

    initial begin
        #45000;                                   // the board's number is read
        say_hello;
        $display("DONE");
        $finish;
    end
endmodule

`default_nettype wire
