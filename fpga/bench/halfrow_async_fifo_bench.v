// Two clocks of every ratio, also almost equal ones whose phase wanders, under every mix of gaps in front and behind: the words
// come out in order and none is lost. What crosses changes one bit at a time, or a register there could see neither value.
`default_nettype none

module halfrow_async_fifo_bench;
    localparam WORDS = 600;

    reg        in_clk, out_clk, rst, in_valid, out_ready;
    reg  [7:0] in_data;
    wire       in_ready, out_valid;
    wire [7:0] out_data;
    integer    in_half, out_half, ratio, gaps, stalls, sent, got, in_clocks, out_clocks, fullest, seed, faults;
    reg        was_stalled;
    reg  [7:0] was_data;
    reg  [4:0] was_tail, was_head;

    halfrow_async_fifo #(.WIDTH(8), .BITS(4)) dut (
        .in_clk(in_clk), .in_rst(rst), .in_valid(in_valid), .in_data(in_data), .in_ready(in_ready),
        .out_clk(out_clk), .out_rst(rst), .out_valid(out_valid), .out_data(out_data), .out_ready(out_ready)
    );

    initial begin
        in_clk  = 0;
        in_half = 500;
        forever #in_half in_clk = ~in_clk;
    end

    initial begin
        out_clk  = 0;
        out_half = 500;
        forever #out_half out_clk = ~out_clk;
    end

    task fault(input [8*30-1:0] what);
        begin
            faults = faults + 1;
            $display("FAIL %0s at %0d (ratio %0d, gaps %0d, stalls %0d)", what, got, ratio, gaps, stalls);
            if (faults > 20) $finish;
        end
    endtask

    `include "pause.vh"

    function [7:0] word(input integer place);
        word = place * 151 + (place >> 8);
    endfunction

    function single(input [4:0] changed);
        single = (changed & (changed - 5'd1)) == 0;
    endfunction

    always @(negedge in_clk) begin
        in_valid = !rst && sent < WORDS && !pause(gaps, in_clocks);
        in_data  = in_valid ? word(sent) : 8'hxx;
    end

    always @(posedge in_clk) begin
        in_clocks = in_clocks + 1;
        if (in_valid && in_ready && !rst) sent = sent + 1;
        if (sent - got > fullest) fullest = sent - got;
        #1 if (!rst && !single(dut.tail_gray ^ was_tail)) fault("two bits cross at once");
        was_tail = dut.tail_gray;
    end

    always @(negedge out_clk) out_ready = !pause(stalls, out_clocks);

    always @(posedge out_clk) begin
        out_clocks = out_clocks + 1;
        if (!rst) begin
            if (was_stalled && (!out_valid || out_data !== was_data)) fault("output not stable");
            if (out_valid && out_ready) begin
                if (got >= sent || out_data !== word(got)) fault("wrong word");
                got = got + 1;
            end
        end
        was_stalled = !rst && out_valid && !out_ready;
        was_data    = out_data;
        #1 if (!rst && !single(dut.head_gray ^ was_head)) fault("two bits cross at once");
        was_head = dut.head_gray;
    end

    task choose(input integer which);
        case (which)
            0:       {in_half, out_half} = {32'd500, 32'd500};
            1:       {in_half, out_half} = {32'd500, 32'd501};
            2:       {in_half, out_half} = {32'd501, 32'd500};
            3:       {in_half, out_half} = {32'd500, 32'd310};
            4:       {in_half, out_half} = {32'd310, 32'd500};
            5:       {in_half, out_half} = {32'd90, 32'd1010};
            default: {in_half, out_half} = {32'd1010, 32'd90};
        endcase
    endtask

    initial begin
        {in_valid, out_ready, was_stalled} = 0;
        {faults, seed} = 1;
        for (ratio = 0; ratio < 7; ratio = ratio + 1) begin
            choose(ratio);
            for (gaps = 0; gaps < 4; gaps = gaps + 1)
                for (stalls = 0; stalls < 4; stalls = stalls + 1) begin
                    rst = 1;
                    {sent, got, in_clocks, out_clocks, fullest} = 0;
                    repeat (4) @(posedge in_clk);
                    repeat (4) @(posedge out_clk);
                    rst = 0;
                    while (got < WORDS && in_clocks < 600000) @(posedge out_clk) #2;
                    repeat (8) @(posedge in_clk);
                    repeat (8) @(posedge out_clk);
                    if (got != WORDS || out_valid) fault("words lost or too many");
                    if (gaps == 0 && stalls == 3 && ratio != 6 && fullest != 17) fault("depth");
                    if (ratio == 0 && gaps == 0 && stalls == 0 && out_clocks > WORDS + 50) fault("slower than a word a clock");
                end
            if (faults == 0) $display("PASS clock halves %0d and %0d", in_half, out_half);
        end
        $display("DONE");
        $finish;
    end
endmodule

`default_nettype wire
