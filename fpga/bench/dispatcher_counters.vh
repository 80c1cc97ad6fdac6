// The counters that STATUS tells, counted and cleared; for halfrow_dispatcher_bench.v.

task events(input [9:0] which, input integer count);
    for (i = 0; i < count; i = i + 1) begin
        {sample_over, row_unneeded, row_repeated, row_left, row_accepted} = which[9:5];
        {framing_error, crc_error} = which[2:1];
        @(negedge clk);
        {sample_over, row_unneeded, row_repeated, row_left, row_accepted, framing_error, crc_error} = 0;
        if (which != 10'h200) repeat (which == 10'h004 ? 2 : 40) @(negedge clk);
    end
endtask

task latencies(input [15:0] first, input [15:0] last);
    begin
        {latency_valid, row_left, first_latency, last_latency} = {2'b11, first, last};
        @(negedge clk);
        {latency_valid, row_left} = 2'b00;   // the latencies stay
    end
endtask

task counters;
    begin
        what = "counters";
        {next_row_in, acknowledged} = 0;
        hello(77, HOST, 1, 1, 1);
        status(0);
        counts(0, 1);
        for (k = 1; k < 16; k = k + 1) counts(k, 0);
        events(10'h200, 2000);
        events(10'h004, 700);
        events(10'h3e6, 300);
        give(ECHO, 0, session + 1);
        give(ROW_ACK, 0, session + 1);
        give(8'h55, 0, session);
        next_row_in  = 32'h04030201;
        acknowledged = 32'h14131211;
        core_busy    = 1;
        latencies(16'd972, 16'd973);
        status(0);
        counts(0, 5);
        counts(1, 300);
        counts(2, 1000);
        counts(3, 2);
        counts(4, 2);
        counts(5, 300);
        counts(6, 301);
        counts(7, 300);
        counts(8, 300);
        counts(9, 2300);
        counts(10, 32'h04030201);
        counts(11, 32'h14131211);
        counts(12, 1);
        counts(13, 0);
        counts(14, 972);
        counts(15, 973);
        latencies(16'd1000, 16'd900);
        repeat (70) @(negedge clk);
        latencies(16'd65535, 16'd901);
        status(1);
        counts(0, 6);
        counts(6, 303);
        counts(14, 900);
        counts(15, 65535);
        core_busy = 0;
        status(1);
        counts(0, 1);
        for (k = 1; k < 16; k = k + 1) if (k != 10 && k != 11) counts(k, 0);
        // The counters before a carry, and at their end.
        for (k = 0; k < 10; k = k + 1) begin
            {dut.status.counters[4*k+3], dut.status.counters[4*k+2], dut.status.counters[4*k+1], dut.status.counters[4*k]}
                = k & 1 ? 32'hfffffffe : 32'h00ffffff;
        end
        events(10'h3e6, 3);
        status(0);
        for (k = 1; k < 10; k = k + 1) if (k != 3 && k != 4) counts(k, k & 1 ? 32'hffffffff : 32'h01000002);
        counts(0, 32'h01000000);
    end
endtask

// Clocks until a row leaves; below 0: none does.
integer leaves_in = -2;
always @(negedge clk) if (leaves_in > -2) begin
    leaves_in = leaves_in - 1;
    if (leaves_in == -1) {latency_valid, row_left, first_latency, last_latency} = {2'b11, 16'h1234, 16'h5678};
    else {latency_valid, row_left} = 2'b00;
end

// A row leaves at every moment of a report that clears: it is in this report or in the next one, and latencies are whole.
task leaving_while_reporting;
    reg [31:0] least, most;
    begin
        what = "a row that leaves during a report";
        for (m = 0; m < 190; m = m + 1) begin
            status(1);
            leaves_in = m;
            status(1);
            while (leaves_in >= 0) @(negedge clk);
            n = counter(6);
            least = counter(14);
            most  = counter(15);
            status(1);
            check(n + counter(6) == 1, "a row that leaves is counted once");
            // Its two latencies may be in two reports.
            case ({least, most, counter(14), counter(15)})
                {64'd0, 32'h1234, 32'h5678}, {32'h1234, 32'h5678, 64'd0}, {{2{32'h1234}}, {2{32'h5678}}}: ;
                default: fault("latencies of one row");
            endcase
        end
    end
endtask
