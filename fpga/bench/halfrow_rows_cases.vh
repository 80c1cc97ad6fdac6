// What halfrow_rows_bench.v does to the way of the rows.

integer n, m, count;
reg [31:0] from;

task sizes_and_gaps;
    begin
        for (n = 0; n < 14; n = n + 1) begin
            ready_percent = n % 3 == 0 ? 100 : n % 3 == 1 ? 40 : 5;
            case (n % 5)
                0: configure(64, 3, 0, n < 5 ? 0 : 1);
                1: configure(66, 1, n * 10, 2463534242);
                2: configure(128, 4, 1, n < 5 ? 0 : 99);
                3: configure(64, 2, 300, 12345);
                4: configure(190, 5, 7, n < 5 ? 0 : 77777);
            endcase
            play(3);
        end
        ready_percent = 100;
        configure(2048, 2, 0, 0);
        play(2);
        configure(2048, 3, 900, 5);
        play(1);
        passed("sizes x blanking x gaps x back-pressure");
    end
endtask

task golden_gaps;
    begin
        configure(64, 4, 0, 1);
        expect_equal("golden pauses", {pauses[0][7:0], pauses[1][7:0], pauses[2][7:0], pauses[3][7:0]}, 32'h060f090a);
        play(2);
        configure(2048, 4, 100, 1);
        expect_equal("golden gaps", {extra[1][3:0], extra[2][3:0], extra[3][3:0]}, 12'h776);
        play(1);
        passed("the golden gaps of the seed 1");
    end
endtask

task credit;
    begin
        configure(64, 8, 0, 0);
        drop(0, 1);
        place(2);
        refused(10);
        place(32'hffffffff);
        refused(10);
        send(1);
        expect_equal("credit without row 0", credit_window, 2);
        expect_equal("next_row_in without row 0", next_row_in, 0);
        place(2);
        refused(10);
        send(0);
        settle;
        expect_equal("credit of two rows", credit_window, 4);
        expect_equal("next_row_in", next_row_in, 2);
        send(2);
        send(3);
        settle;
        expect_equal("credit while no out-bank is free", credit_window, 4);
        expect_equal("next_row_in of rows that wait", next_row_in, 4);
        window = 32'hffffffff;
        pulse_acknowledge;
        settle;
        expect_equal("acknowledged no further than sent", acknowledged, 1);
        expect_equal("credit", credit_window, 5);
        window = 0;
        pulse_acknowledge;
        settle;
        expect_equal("a smaller window", acknowledged, 1);
        window = 1;
        place(0);
        count = unneeded;
        refused(0);
        expect_equal("unneeded", unneeded - count, 1);
        passed("credit and acknowledgement");
    end
endtask

task order;
    begin
        configure(64, 4, 0, 0);
        drop(100, 0);
        count = accepted;
        put(100, 0, 0, 62, 0); refused(11);
        put(100, 0, 0, 66, 0); refused(11);
        put(100, 0, 0, 0, 0); refused(11);
        put(100, 0, 4, 64, 0); refused(11);
        put(100, 0, 65535, 64, 0); refused(11);
        put(100, 0, 256, 64, 0); refused(11);
        put(100, 0, 0, 64, 1); refused(11);
        put(100, 0, 1, 64, 0); refused(11);
        put(100, 0, 3, 64, 1); refused(11);
        put(101, 0, 3, 64, 0); refused(11);
        place(100); packet_length = packet_length - 1; refused(3);
        place(100); packet_length = 11; refused(3);
        place(99); packet_length = 0; refused(3);
        put(100, 0, 0, 4096, 0); packet_length = 4080; refused(3);
        put(100, 0, 0, 65535, 0); packet_length = 4080; refused(3);
        expect_equal("none accepted", accepted - count, 0);
        send(100);
        settle;
        put(101, 0, 2, 64, 0); refused(11);
        put(101, 1, 1, 64, 0); refused(11);
        put(101, 256, 1, 64, 0); refused(11);
        put(101, 0, 257, 64, 0); refused(11);
        send(102);
        put(102, 0, 3, 64, 0);
        count = unneeded;
        refused(0);
        expect_equal("unneeded", unneeded - count, 1);
        send(101);
        settle;
        next_new = 101;
        acknowledge_all;
        send(103);
        settle;
        for (n = 0; n < 2; n = n + 1)
            acknowledge_all;
        expect_equal("all came back", {acknowledged[15:0], 13'd0, rows_waiting, rows_held, core_busy}, {16'd104, 16'd0});
        passed("order and places");

        generation = 0;
        place(104); refused(8);
        commit_pending = 1; commit_frame = 7; commit_generation = 9;
        place(104); refused(8);
        for (n = 2; n > 0; n = n - 1) begin
            put(103 + n, 6 + n, 0, 64, 0);
            due(103 + n, 6 + n, 0, 9);
            refused(0);
        end
        settle;
        expect_equal("the commit took effect", {generation, 7'd0, commit_pending}, {8'd9, 8'd0});
        expect_equal("one row has come back", next_new, 105);
        passed("tables that are not there yet");
    end
endtask

task loss;
    begin
        configure(64, 4, 0, 0);
        drop(0, 1);
        send(0);
        settle;
        place(0);
        count = unneeded;
        refused(0);
        expect_equal("a row inside the core", unneeded - count, 1);
        send(1);
        settle;
        count = repeated;
        m = received;
        ready_percent = 10;
        for (n = 0; n < 5; n = n + 1) begin
            put(0, 77, 1, 64, 0);
            refused(0);
        end
        settle;
        expect_equal("repeats", repeated - count, 5);
        expect_equal("repeats that came back", received - m, 5);
        // Acknowledged while it is sent again, and behind it a row for its bank.
        put(0, 77, 1, 64, 0);
        refused(0);
        window = 1;
        send(2);
        settle;
        expect_equal("all came back", next_new, 2);
        ready_percent = 100;
        window = 2;
        send(3);
        settle;
        acknowledge_all;
        expect_equal("nothing is left", {acknowledged[15:0], 13'd0, rows_waiting, rows_held, core_busy}, {16'd4, 16'd0});
        passed("rows that are asked for again");
    end
endtask

task frames_follow;
    begin
        for (n = 0; n < 4; n = n + 1) begin
            configure(n < 2 ? 64 : 512, 1, n % 2 * 21, 0);
            drop(0, 0);
            commit_pending = 1; commit_frame = 1; commit_generation = generation + 1;
            started = core.rows;
            send(1);
            send(0);
            settle;
            expect_equal("both came back", next_new, 2);
            expect_equal("clocks between two frames", core.blank_before[started[11:0] + 12'd1], blanking);
            expect_equal("banks of two frames", core.bank_of[started[11:0]] ^ core.bank_of[started[11:0] + 12'd1], 1);
        end
        passed("a frame with other tables behind the one before, at least blanking");
    end
endtask

task samples_over;
    begin
        configure(64, 1, 0, 0);
        for (n = 0; n < 3; n = n + 1) begin
            depth = n;
            drop(n, 0);
            count = 0;
            for (m = 0; m < 64; m = m + 1)
                if (sample_of(n, m) >> (8 + 2 * n) != 0)
                    count = count + 1;
            over = 0;
            put(n, 0, 1, 64, 0); refused(11);
            send(n);
            place(n); refused(0);
            settle;
            expect_equal("samples over", over, count);
        end
        acknowledge_all;
        passed("samples beyond the depth");
    end
endtask

task resets;
    begin
        asks = $test$plusargs("all") || $test$plusargs("fault") ? 100 : 12;
        for (n = 0; n < asks; n = n + 1) begin
            settle;
            drop(n * 50, n % 3 == 0);
            configure(n % 4 == 0 ? 128 : 64, 3, n % 7, n % 2 * n);
            ready_percent = n % 5 == 0 ? 5 : 100;
            from = next_new;
            send(from);
            if (n % 3 != 0)
                send(from + 1);
            repeat ($random & 511) @(negedge clk);
            if (n % 6 == 1) begin
                // In the middle of taking a row.
                place(from + 2);
                @(negedge clk) row_start = 1;
                @(negedge clk) row_start = 0;
                repeat ($random & 127) @(negedge clk);
            end
            drop(from + 10, n % 2);
            expect_equal("credit behind a reset", credit_window, from + 12);
            expect_equal("next_row_in behind a reset", next_row_in, from + 10);
            expect_equal("nothing is left", {rows_waiting, rows_held, core_busy}, 0);
            play(2);
        end
        passed("resets in the middle of anything");
    end
endtask

task last_numbers;
    begin
        configure(64, 1, 0, 0);
        for (n = 3; n > 0; n = n - 1) begin
            drop(-n, 0);
            for (m = n; m > 1; m = m - 1) begin
                send(-m);
                settle;
                acknowledge_all;
            end
            place(32'hffffffff); refused(10);
            expect_equal("the last number", next_row_in, 32'hffffffff);
            expect_equal("the last credit", credit_window, 32'hffffffff);
            expect_equal("the last acknowledgement", acknowledged, 32'hffffffff);
        end
        passed("the last row numbers of all");
    end
endtask

task lossy_host;
    begin
        configure(64, 5, 3, 4242);
        drop(1000, 1);
        asks = $test$plusargs("all") ? 3000 : $test$plusargs("fault") ? 1000 : 400;
        for (n = 0; n < asks; n = n + 1) begin
            ready_percent = n / 100 % 2 ? 100 : 20;
            // A host that loses what comes back does not acknowledge it, and asks again.
            if ($random % 3 == 0)
                window = next_new;
            from = window + ($random & 7) - 2;
            place(from);
            if (from >= next_row_in && from < credit_window)
                send(from);
            else if (from < next_row_in)
                refused(0);
            else if (from >= credit_window + 2)
                refused(10);
            if ($random % 4 == 0)
                settle;
        end
        for (n = 0; n < 3; n = n + 1) begin
            settle;
            acknowledge_all;
        end
        expect_equal("enough rows came back", acknowledged > 1000 + asks / 15, 1);
        passed("a host that loses and asks again");
    end
endtask

// A row is dropped at each byte of its packet, or at every other one; other rows with its place in the banks follow at once,
// in another width and generation.
task dropped_while_sent;
    begin
        for (n = 0; n < 30; n = n + ($test$plusargs("all") || $test$plusargs("fault") ? 1 : 2)) begin
            configure(64, 1, 0, 0);
            ready_percent = 100;
            drop(n * 64, 0);
            send(n * 64);
            while (at < n) @(negedge clk);
            m = received;
            ready_percent = n % 3 == 0 ? 5 : 20;
            drop(n * 64 + 32'h01010104 + n % 3 * 4, n % 2); // no byte of its number is as before, nor of its frame's
            base = base - 32'h0202;
            generation = generation == 255 ? 1 : generation + 1;
            configure(n % 4 < 2 ? 96 : 64, 1, 0, 0);
            send(next_new);
            send(next_new + 1);
            settle;
            expect_equal("the dropped row and both others came", received - m, 3);
            acknowledge_all;
            expect_equal("nothing is left", {rows_waiting, rows_held, core_busy}, 0);
        end
        ready_percent = 100;
        passed("rows that are dropped while they are sent");
    end
endtask

// Counters that no bench could play to their end.
task ends_of_counters;
    begin
        configure(64, 1, 0, 0);
        drop(0, 1);
        rows.row_sender.packets = 16'hfffe;
        packets = 65534;
        for (n = 0; n < 4; n = n + 1) begin
            send(n);
            settle;
            acknowledge_all;
        end

        send(4);
        settle;
        {rows.heads.bytes[3], rows.heads.bytes[2]} = 16'hfffc;
        rows.row_sender.greatest = 0;
        repeats_of[4] = 65533;
        for (n = 0; n < 5; n = n + 1) begin
            place(4);
            refused(0);
            settle;
        end
        expect_equal("repeats at their end", {bytes[19], bytes[18]}, 65535);
        acknowledge_all;
        passed("the last number of a packet and the most repeats");

        configure(64, 2, 0, 99);
        base = 5;
        rows.player.pauses = 16'hffff - pauses[0] + 1;
        pauses[0] = 65535;
        send(5);
        send(6);
        settle;
        expect_equal("both came back", next_new, 7);
        acknowledge_all;
        passed("the most pauses");

        if ($test$plusargs("all")) begin
            configure(64, 2, 33000, 0);
            play(1);
            configure(64, 258, 0, 0);
            play(1);
            passed("a blanking of 16 bits, and rows whose number takes two bytes");
        end
    end
endtask

initial begin
    repeat (4) @(negedge clk);
    rst = 0;
    sizes_and_gaps;
    golden_gaps;
    credit;
    order;
    loss;
    frames_follow;
    samples_over;
    resets;
    last_numbers;
    lossy_host;
    dropped_while_sent;
    // Presets need registers by their names, which a netlist does not keep.
    if (!$test$plusargs("fault")) ends_of_counters;
    $display("DONE");
    $finish;
end
