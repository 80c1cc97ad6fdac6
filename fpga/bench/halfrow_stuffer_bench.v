// Drawn packets, with and without zeros and of lengths about the longest run, against a stuffer that sees the whole packet at
// once. Whatever is not valid is driven with x.
`default_nettype none

module halfrow_stuffer_bench;
    localparam PACKETS = 24;

    reg        clk, rst, in_valid, in_last, out_ready;
    reg  [7:0] in_data;
    wire       in_ready, out_valid, idle;
    wire [7:0] out_data;

    halfrow_stuffer dut (
        .clk(clk), .rst(rst), .in_valid(in_valid), .in_data(in_data), .in_last(in_last), .in_ready(in_ready),
        .out_valid(out_valid), .out_data(out_data), .out_ready(out_ready), .idle(idle)
    );

    reg [7:0] plain  [0:262143];
    reg       last   [0:262143];
    reg [7:0] wanted [0:262143];
    integer   plain_total, wanted_total, in, out, gaps, stalls, clocks, seed, faults;
    reg       was_stalled;
    reg [7:0] was_data;

    initial clk = 0;
    always #5 clk = ~clk;

    task fault(input [8*30-1:0] what);
        begin
            faults = faults + 1;
            $display("FAIL %0s at byte %0d (gaps %0d, stalls %0d)", what, out, gaps, stalls);
            if (faults > 20) $finish;
        end
    endtask

    `include "pause.vh"

    task want(input [7:0] value);
        begin
            wanted[wanted_total] = value;
            wanted_total         = wanted_total + 1;
        end
    endtask

    // Cuts the packet from `from` to `to` at its zeros and behind 254 other bytes.
    task stuff(input integer from, input integer to);
        integer at, run, n;
        reg     more;
        begin
            want(8'd0);
            at   = from;
            more = 1;
            while (more) begin
                run = 0;
                while (at + run < to && run < 254 && plain[at+run] != 0) run = run + 1;
                want(run + 1);
                for (n = 0; n < run; n = n + 1) want(plain[at+n]);
                at   = at + run;
                more = at < to;
                if (run < 254) at = at + 1;
            end
            want(8'd0);
        end
    endtask

    task draw;
        integer packet, size, from, n, sort;
        begin
            {plain_total, wanted_total} = 0;
            for (packet = 0; packet < PACKETS; packet = packet + 1) begin
                case (packet % 4)
                    0:       size = 1 + ($random(seed) & 15);
                    1:       size = 252 + ($random(seed) & 3);
                    2:       size = 506 + ($random(seed) & 3);
                    default: size = packet == 3 ? 4096 : 1 + ($random(seed) & 511);
                endcase
                sort = $random(seed) & 3;
                from = plain_total;
                for (n = 0; n < size; n = n + 1) begin
                    plain[from+n] = $random(seed);
                    if (sort == 0 || (sort == 1 && ($random(seed) & 255)) != 0) plain[from+n] = plain[from+n] | 8'h10;
                    if (sort == 2 && ($random(seed) & 1)) plain[from+n] = 0;
                    last[from+n] = n == size - 1;
                end
                plain_total = from + size;
                stuff(from, plain_total);
            end
        end
    endtask

    task one_clock;
        begin
            in_valid  = in < plain_total && !pause(gaps, clocks);
            in_data   = in_valid ? plain[in] : 8'hxx;
            in_last   = in_valid ? last[in] : 1'bx;
            out_ready = !pause(stalls, clocks);
            #1 if (was_stalled && (!out_valid || out_data !== was_data)) fault("output not stable");
            was_stalled = out_valid && !out_ready;
            was_data    = out_data;
            if (out_valid && out_ready) begin
                if (out >= wanted_total || out_data !== wanted[out]) fault("wrong byte");
                out = out + 1;
            end
            if (in_valid && in_ready) in = in + 1;
            @(posedge clk) #1 clocks = clocks + 1;
        end
    endtask

    initial begin
        {faults, seed} = 1;
        for (gaps = 0; gaps < 4; gaps = gaps + 1)
            for (stalls = 0; stalls < 4; stalls = stalls + 1) begin
                {in, out, clocks, was_stalled, in_valid} = 0;
                draw;
                rst = 1;
                repeat (2) @(posedge clk);
                #1 rst = 0;
                while (out < wanted_total && clocks < 10 * wanted_total) one_clock;
                repeat (300) one_clock;
                if (out != wanted_total || in != plain_total || !idle) fault("bytes missing");
                if (gaps == 0 && stalls == 0 && clocks > wanted_total + PACKETS + 600) fault("slower than a byte a clock");
                if (faults == 0) $display("PASS %0d packets, %0d bytes, gaps %0d, stalls %0d", PACKETS, out, gaps, stalls);
            end
        $display("DONE");
        $finish;
    end
endmodule

`default_nettype wire
