// The board's answers to requests that the tables have no part in, and its counters, byte by byte against WIRE.md and the
// frozen packets, with a sender that takes bytes at once, sometimes and seldom.
`default_nettype none

module halfrow_dispatcher_bench;
    localparam MAX_WIDTH = 1920, MAX_HEIGHT = 1080, GRID = 0, ENTRY_BITS = 11, TAPS = 7, LEAST_BLANKING = 7, TABLE_BANKS = 2,
               ROW_BANKS_IN = 4, ROW_BANKS_OUT = 3;
    `include "dispatcher_harness.vh"
    `include "dispatcher_vectors.vh"

    localparam HOST = 32'h00c0ffee, OTHER = 32'h00000b0b;
    integer k, m;

    task milliseconds(input integer count);
        repeat (count) begin
            millisecond = 1;
            @(negedge clk);
            millisecond = 0;
            @(negedge clk);
        end
    endtask

    task status(input clear);
        begin
            payload[0] = clear ? 8'h80 : 8'h00;
            give(STATUS, 1, session);
            replied(STATUS, 64);
        end
    endtask

    function [31:0] counter(input integer number);
        counter = {got[4*number+3], got[4*number+2], got[4*number+1], got[4*number]};
    endfunction

    task counts(input integer number, input [31:0] value);
        if (counter(number) !== value) begin
            $display("counter %0d is %0d instead of %0d", number, counter(number), value);
            fault("a counter");
        end
    endtask

    // Behind what is frozen: content 1, 16 records, 256 clocks between frames, a trap; what entered is told.
    task capabilities;
        begin
            load_vector("capabilities-reply");
            check(got_total == vector_total - 16 + 12, "the length of the capabilities");
            for (i = 12; i < vector_total - 4; i = i + 1) check(got[i-12] === vector[i], "the capabilities");
            check({got[got_total-12], got[got_total-11], got[got_total-10], got[got_total-9], got[got_total-8], got[got_total-7],
                   got[got_total-6], got[got_total-5], got[got_total-4]} === 72'h100701001000000101, "the capability of bursts");
            check({got[got_total-3], got[got_total-2], got[got_total-1]} === 24'h110101, "the capability of what entered");
        end
    endtask

    task bursts;
        begin
            what = "bursts";
            for (k = 0; k < 17; k = k + 1) payload[k] = 8'h30 + k;
            m = burst_requests;
            give(BURST, 17, session);
            replied(BURST, 0);
            give(RECORDS, 4, session);
            replied(RECORDS, 298);
            for (k = 0; k < 298; k = k + 1) check(got[k] === (k[7:0] ^ 8'h5a), "a byte of the records");
            give(TRAP, 0, session);
            replied(TRAP, 298);
            for (k = 0; k < 298; k = k + 1) check(got[k] === (k[7:0] ^ 8'h5a), "a byte of the trapped row");
            for (k = 0; k < 20; k = k + 1) payload[k] = 8'h30 + k;
            give(EXPECT, 20, session);
            replied(EXPECT, 0);
            {burst_refusal, burst_detail} = {4'd4, 16'd5};
            give(BURST, 17, session);
            refused(BURST, RANGE, 5);
            give(RECORDS, 4, session);
            refused(RECORDS, RANGE, 5);
            burst_detail = 16'hfedc;
            give(EXPECT, 20, session);
            refused(EXPECT, RANGE, 16'hfedc);
            {burst_refusal, burst_detail} = 20'd0;
            check(burst_requests == m + 7, "a request of bursts gets there once");
            // 10 s without a packet end a burst and its session, and drop no row. Without a burst they do not.
            m = drops;
            silences = 0;
            milliseconds(10100);
            check(session_open && silences == 0, "nobody is waited for without a burst");
            give(ROW_ACK, 0, session);
            burst = 1;
            milliseconds(9999);
            check(session_open && silences == 0, "10 s have not passed");
            milliseconds(1);
            repeat (3) @(negedge clk);
            burst = 0;
            check(!session_open && silences > 0 && drops == m, "10 s of silence");
            hello(k, HOST, 1, 1, 0);
            replied(HELLO, 22);
        end
    endtask

    task vectors;
        begin
            what = "the frozen packets";
            for (k = 0; k < 91; k = k + 1) hello(k, HOST, 1, 1, 0);
            give_vector("hello-request");
            like_vector("hello-reply");
            give_vector("capabilities-request");
            capabilities;
            give_vector("echo-request");
            like_vector("echo-reply");
            give_vector("echo-largest");
            like_vector("echo-largest");
            give_vector("configure-request");
            like_vector("configure-reply");
            check({configured, width, height, centre2, blanking, gap_seed, depth}
                  === {1'b1, 12'd1920, 12'd1080, 13'd1919, 16'd900, 32'hdeadbeef, 2'd2}, "the settings");
            give_vector("table-write-request-rows");
            like_vector("table-write-reply");
            put_span(STEPS, SHADOW, 0, 1072, 8);
            packet_sequence = 10 - 257;
            give(TABLE_READ, 7, 92);
            like_vector("table-read-reply-rows");
            give_vector("table-write-request-kernel");
            replied(TABLE_WRITE, 0);
            commit_shadow(513, 254);
            replied(COMMIT, 1);
            give_vector("table-read-request");
            check(got[7] === 0, "the active bank is not yet the written one");
            check(generation === 0 && active_bank === 0 && commit_pending === 1 && commit_frame === 513, "a commit is pending");
            begin_frame(512);
            check(generation === 0, "not yet");
            begin_frame(513);
            check(generation === 254 && active_bank === 1 && commit_pending === 0, "a commit takes effect");
            give_vector("table-read-request");
            like_vector("table-read-reply-kernel");
            give_vector("commit-request");
            like_vector("commit-reply");
            give_vector("reset-request");
            like_vector("reset-reply");
            give_vector("payload-too-short");
            refused(vector[1], PAYLOAD, 0);
            give_vector("payload-without-meaning");
            refused(vector[1], PAYLOAD, 0);
            give_vector("payload-entries-too-short");
            refused(vector[1], PAYLOAD, 0);
            give_vector("unknown-kind");
            refused(vector[1], KIND_UNKNOWN, 0);
            give_vector("appended-bytes-request");
            check(got_kind === vector[1], "a request with appended bytes is refused");
        end
    endtask

    task silence;
        begin
            milliseconds(150);
            hello(8, OTHER, 1, 1, 0);
            refused(HELLO, HELD, 99);
            hello(8, HOST, 2, 2, 0);
            hello(8, OTHER, 1, 1, 0);
            refused(HELLO, HELD, 100);
            milliseconds(9999);
            hello(8, OTHER, 1, 1, 0);
            refused(HELLO, HELD, 1);
            give(ROW_ACK, 0, session);
            milliseconds(9999);
            give(ROW_ACK, 0, session + 1);
            milliseconds(1);
            hello(8, OTHER, 1, 1, 0);
            replied(HELLO, 22);
        end
    endtask

    task sessions;
        begin
            what = "sessions";
            hello(1, HOST, 1, 1, 0);
            replied(HELLO, 22);
            n = session;
            m = drops;
            hello(1, HOST, 1, 9, 0);
            check(session == n && drops == m, "a repeated HELLO changes nothing");
            for (k = 0; k < (stall == 0 ? 300 : 20); k = k + 1) begin
                hello(k + 2, HOST, 0, 255, 0);
                check(got[9] === session && session == (n == 255 ? 1 : n + 1), "the next session");
                check(drops == m + 1 && last_drop == 0, "rows are dropped");
                n = session;
                m = drops;
            end
            hello(7, HOST, 2, 255, 0);
            refused(HELLO, VERSION_WRONG, 1);
            hello(7, HOST, 0, 0, 0);
            refused(HELLO, VERSION_WRONG, 1);
            if (stall == 0) silence;
            else hello(8, OTHER, 1, 1, 1);
            hello(9, HOST, 1, 1, 0);
            refused(HELLO, HELD, 100);
            hello(9, HOST, 1, 1, 64);
            replied(HELLO, 22);
            n = new_sessions;
            hello(9, OTHER, 1, 1, 1);
            check(session == got[9] && new_sessions == n + 1, "the same nonce of another host opens another session");
            payload[0] = 0;
            give(RESET, 5, session + 1);
            refused(RESET, SESSION, 0);
            give(8'h55, 0, 0);
            refused(8'h55, SESSION, 0);
            give(ROW_IN, 20, session - 1);
            refused(ROW_IN, SESSION, 0);
            give(ROW_ACK, 0, session - 1);
            unanswered;
            n = acknowledges;
            packet_window = 32'h87654321;
            hello(9, OTHER, 1, 1, 1);
            check(acknowledges == n, "HELLO acknowledges nothing");
            give(8'h55, 0, session);
            check(acknowledges == n + 1 && last_acknowledge == 32'h87654321, "every packet of the session acknowledges");
            n = session;
            put32(1, 32'h01020304);
            payload[0] = 1;
            give(RESET, 5, session);
            check(last_drop == 32'h01020304 && !session_open && session == 0, "a reset closes the session");
            give(RESET, 5, n);
            refused(RESET, SESSION, 0);
            give(ECHO, 0, 0);
            refused(ECHO, SESSION, 0);
            hello(9, OTHER, 1, 1, 0);
            check(session == n + 1, "a nonce opens another session once its own is closed");
            payload[0] = 2;
            give(RESET, 5, session);
            check(session == n + 1 && !configured && generation == 0, "a reset of tables keeps the session");
        end
    endtask

    task payloads;
        begin
            what = "kinds and payloads";
            for (k = 1; k < 256; k = k + 1)
                case (k)
                    CAPABILITIES, ECHO, ROW_IN, ROW_ACK, TRAP: ;
                    STATUS, RESET, TABLE_WRITE, TABLE_READ, TABLE_CRC, COMMIT, CONFIGURE, BURST, RECORDS, EXPECT: begin
                        m = k == BURST ? 17 : k == RECORDS || k == EXPECT ? 4 : k == STATUS ? 1 : k == RESET ? 5 : k == COMMIT ? 11 : k == CONFIGURE ? 13 : 7;
                        for (i = 0; i < 20; i = i + 1) payload[i] = 0;
                        for (n = 0; n <= m + 1; n = n + 1) begin
                            give(k, n, session);
                            if (n < m) refused(k, PAYLOAD, 0);
                            else check(got_kind === k || got[0] !== PAYLOAD, "a payload of the right length");
                        end
                    end
                    default: begin
                        give(k, k & 15, session);
                        refused(k, KIND_UNKNOWN, 0);
                    end
                endcase
            for (n = 0; n < 11; n = n + 1) begin
                give(HELLO, n, 0);
                refused(HELLO, PAYLOAD, 0);
            end
            for (n = 3; n < 256; n = n + 36) begin
                payload[0] = n;
                give(RESET, 5, session);
                refused(RESET, PAYLOAD, 0);
            end
            for (k = 0; k < 300; k = k + 23) begin
                for (n = 0; n < k; n = n + 1) payload[n] = n * 7 + k;
                give(ECHO, k, session);
                replied(ECHO, k);
                for (n = 0; n < k; n = n + 1) check(got[n] === payload[n], "an echo");
            end
            row_answer = 0;
            n          = row_starts;
            give(ROW_IN, 108, session);
            unanswered;
            row_answer = CREDIT;
            give(ROW_IN, 108, session);
            refused(ROW_IN, CREDIT, 0);
            check(row_starts == n + 2, "rows go to the row path");
        end
    endtask

    task wrong_setting(input integer field, input integer w, input integer h, input integer c, input integer b, input integer bits);
        begin
            configure(w, h, c, b, 5, bits);
            refused(CONFIGURE, RANGE, field);
            check({width, height, centre2, blanking, gap_seed, depth} === {12'd640, 12'd480, 13'd1278, 16'd7, 32'd9, 2'd1},
                  "the settings stay");
        end
    endtask

    task settings;
        begin
            what = "settings";
            configure(64, 1, 0, 7, 0, 8);
            check({width, height, centre2, blanking, depth} === {12'd64, 12'd1, 13'd0, 16'd7, 2'd0}, "the least settings");
            configure(1920, 1080, 3838, 65535, 32'hffffffff, 12);
            check({width, height, centre2, blanking, gap_seed, depth}
                  === {12'd1920, 12'd1080, 13'd3838, 16'hffff, 32'hffffffff, 2'd2}, "the greatest settings");
            configure(640, 480, 1278, 7, 9, 10);
            replied(CONFIGURE, 0);
            wrong_setting(0, 62, 480, 0, 7, 12);
            wrong_setting(0, 63, 480, 0, 7, 12);
            wrong_setting(0, 65, 0, 65535, 0, 12);
            wrong_setting(0, 1922, 480, 0, 7, 12);
            wrong_setting(0, 65534, 480, 0, 7, 12);
            wrong_setting(1, 64, 0, 127, 0, 12);
            wrong_setting(1, 64, 1081, 0, 7, 12);
            wrong_setting(2, 64, 1, 127, 0, 12);
            wrong_setting(2, 1920, 1, 3839, 7, 12);
            wrong_setting(2, 1920, 1, 65535, 7, 12);
            wrong_setting(3, 64, 1, 126, 6, 12);
            wrong_setting(5, 64, 1, 126, 7, 9);
            wrong_setting(5, 0, 0, 126, 7, 28);
            for (k = 0; k < 3; k = k + 1) begin
                {rows_waiting, rows_held, core_busy} = 1 << k;
                configure(0, 480, 0, 7, 5, 12);
                refused(CONFIGURE, BUSY, 0);
            end
            {rows_waiting, rows_held, core_busy} = 0;
        end
    endtask

    `include "dispatcher_counters.vh"

    initial begin
        start_up;
        for (k = 0; k < 300; k = k + 1) @(negedge clk);
        vectors;
        passed;
        // Without a stall, and with the most.
        for (stall = 0; stall < 3; stall = stall + ($test$plusargs("all") || $test$plusargs("fault") ? 1 : 2)) begin
            sessions;
            if (stall == 2) passed;
            payloads;
            bursts;
            if (stall == 2) passed;
            settings;
            if (stall == 2) passed;
            counters;
            if (stall == 2) passed;
        end
        stall = 0;
        leaving_while_reporting;
        passed;
        $display("DONE");
        $finish;
    end
endmodule

`default_nettype wire
