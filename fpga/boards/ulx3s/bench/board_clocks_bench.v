// The clocks of the ULX3S: no lock and no clock for the link while the first of both PLLs is not locked.
`timescale 1ns / 1ps
`default_nettype none

module board_clocks_bench;
    reg     oscillator = 0;
    wire    link_clk, locked, pixclk_direct, clk;
    integer clocks = 0;

    always #20 oscillator = !oscillator;
    always @(posedge link_clk) clocks = clocks + 1;

    board_clocks dut (
        .oscillator(oscillator), .pixclk(1'b0), .choose_pixclk(1'b0), .link_clk(link_clk), .locked(locked),
        .pixclk_direct(pixclk_direct), .clk(clk));

    task watch(input [8*48-1:0] what, input due);
        begin
            clocks = 0;
            #1000;
            if (locked === due && (clocks > 20) === due) $display("PASS %0s", what);
            else $display("FAIL %0s: locked %b, %0d clocks", what, locked, clocks);
        end
    endtask

    initial begin
        watch("both PLLs are locked", 1);
        force dut.first_locked = 1'b0;
        watch("the first is not: neither is the second", 0);
        release dut.first_locked;
        watch("both are again", 1);
        $display("DONE");
        $finish;
    end
endmodule

`default_nettype wire
