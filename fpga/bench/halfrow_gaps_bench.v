// The generator of gaps against the first values of xorshift32.
`default_nettype none

module halfrow_gaps_bench;
    reg clk = 0;
    always #5 clk = !clk;

    reg         rst = 1, burst = 0, restart = 0, draw = 0, good = 1;
    reg  [31:0] seed = 0, x, foreseen;
    wire [3:0]  drawn;
    wire [31:0] next;
    wire        on;
    integer     n;

    halfrow_gaps gaps (
        .clk(clk), .rst(rst), .burst(burst), .seed(seed), .restart(restart), .draw(draw), .drawn(drawn), .next(next),
        .on(on));

    task begin_with(input [31:0] wanted);
        begin
            seed = wanted;
            restart = 1;
            @(negedge clk) restart = 0;
        end
    endtask

    initial begin
        @(negedge clk) rst = 0;
        begin_with(2463534242);
        draw = 1;
        @(negedge clk) draw = 0;
        if (gaps.x === 723471715 && on)
            $display("PASS the first value of 2463534242");
        else
            $display("FAIL the first value of 2463534242: %0d", gaps.x);
        begin_with(1);
        x = 1;
        draw = 1;
        for (n = 0; n < 10000; n = n + 1) begin
            @(negedge clk);
            x = x ^ x << 13;
            x = x ^ x >> 17;
            x = x ^ x << 5;
            good = good && gaps.x === x && drawn === x[3:0];
            good = good && (n == 0 || x === foreseen);
            foreseen = next;
        end
        draw = 0;
        if (good)
            $display("PASS 10000 values of 1");
        else
            $display("FAIL 10000 values of 1");
        burst = 1;
        begin_with(1);
        if (!on)
            $display("PASS no gaps in a burst");
        else
            $display("FAIL no gaps in a burst");
        burst = 0;
        begin_with(0);
        if (!on)
            $display("PASS no gaps with the seed 0");
        else
            $display("FAIL no gaps with the seed 0");
        $display("DONE");
        $finish;
    end
endmodule

`default_nettype wire
