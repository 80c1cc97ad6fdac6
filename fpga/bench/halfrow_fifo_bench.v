// Three depths under every mix of gaps in front and behind: the bytes come out in order and none is lost, the queue fills to
// what it says and empties again, and `used` never tells more than that.
`default_nettype none

module halfrow_fifo_bench;
    reg        clk, rst;
    reg  [2:0] start, finished;
    integer    faults [0:2];
    genvar     g;

    initial clk = 0;
    always #5 clk = ~clk;

    generate
        for (g = 0; g < 3; g = g + 1) begin : size
            localparam BITS = g == 0 ? 2 : g == 1 ? 4 : 6;
            localparam MOST = 1 << BITS;  // with the word at the output

            reg            in_valid, out_ready;
            reg  [7:0]     in_data;
            wire           in_ready, out_valid;
            wire [7:0]     out_data;
            wire [BITS-1:0] used;
            reg            was_stalled;
            reg  [7:0]     was_data;
            integer        gaps, stalls, sent, got, fullest, seed, clocks;

            halfrow_fifo #(.WIDTH(8), .BITS(BITS)) dut (
                .clk(clk), .rst(rst), .in_valid(in_valid), .in_data(in_data), .in_ready(in_ready),
                .out_valid(out_valid), .out_data(out_data), .out_ready(out_ready), .used(used)
            );

            task fault(input [8*30-1:0] what);
                begin
                    faults[g] = faults[g] + 1;
                    $display("FAIL depth %0d, gaps %0d, stalls %0d: %0s at %0d", MOST, gaps, stalls, what, got);
                end
            endtask

            `include "pause.vh"

            // The word is a function of its place, so that one lost or doubled shows at once.
            function [7:0] word(input integer place);
                word = place * 151 + (place >> 8);
            endfunction

            task one_clock;
                begin
                    in_valid  = sent < 2000 && !pause(gaps, clocks);
                    in_data   = in_valid ? word(sent) : 8'hxx;
                    out_ready = !pause(stalls, clocks);
                    #1 if (was_stalled && (!out_valid || out_data !== was_data)) fault("output not stable");
                    was_stalled = out_valid && !out_ready;
                    was_data    = out_data;
                    if (out_valid && out_ready) begin
                        if (out_data !== word(got)) fault("wrong word");
                        got = got + 1;
                    end
                    if (in_valid && in_ready) sent = sent + 1;
                    @(posedge clk) #1 clocks = clocks + 1;
                    if (sent - got > fullest) fullest = sent - got;
                    if (used != sent - got - out_valid) fault("used");
                end
            endtask

            initial begin
                {faults[g], sent, got, fullest, clocks, seed} = 1;
                {finished[g], in_valid, out_ready, was_stalled} = 0;
                wait (start[g]);
                for (gaps = 0; gaps < 4; gaps = gaps + 1)
                    for (stalls = 0; stalls < 4; stalls = stalls + 1) begin
                        {sent, got, fullest, clocks} = 0;
                        while (got < 2000 && clocks < 40000) one_clock;
                        repeat (4) one_clock;
                        if (got != 2000 || out_valid) fault("words lost or too many");
                        if (gaps == 0 && stalls == 0 && clocks > 2010) fault("slower than a word a clock");
                        if (fullest > MOST || stalls == 3 && gaps == 0 && fullest != MOST) fault("depth");
                    end
                if (faults[g] == 0) $display("PASS depth %0d", MOST);
                finished[g] = 1;
            end
        end
    endgenerate

    initial begin
        start = 0;
        rst   = 1;
        repeat (2) @(posedge clk);
        #1 rst = 0;
        start  = 7;
        wait (finished === 7);
        $display("DONE");
        $finish;
    end
endmodule

`default_nettype wire
