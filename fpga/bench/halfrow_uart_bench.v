// Bytes over the line both ways at three speeds: clocks that are off by 2.5 %, noise of one clock, starts that were none, bytes
// without a stop bit, breaks, a sender that runs on for 16 bytes when told to stop, and a receiver that says stop.
`default_nettype none

module halfrow_uart_bench;
    localparam PERIOD = 1000;  // of the clock

    reg clk;
    reg [2:0] start, finished;
    genvar g;

    initial clk = 0;
    always #(PERIOD / 2) clk = ~clk;

    generate
        for (g = 0; g < 3; g = g + 1) begin : speed
            localparam DIVIDER = g == 0 ? 6 : g == 1 ? 8 : 17;
            localparam BYTES   = g == 2 ? 90 : 150;

            reg        rst, rxd, cts_n, rx_ready, tx_valid;
            reg  [7:0] tx_data;
            wire       txd, rts_n, rx_valid, tx_ready, byte_lost;
            wire [7:0] rx_data;
            integer    faults, seed, stalls, gaps, bit_time, sent, got, lost, more, on_line, begun, n, mixes;
            real       skew;

            halfrow_uart #(.DIVIDER(DIVIDER)) dut (
                .clk(clk), .rst(rst), .rxd(rxd), .txd(txd), .rts_n(rts_n), .cts_n(cts_n), .rx_valid(rx_valid),
                .rx_data(rx_data), .rx_ready(rx_ready), .tx_valid(tx_valid), .tx_data(tx_data), .tx_ready(tx_ready),
                .byte_lost(byte_lost)
            );

            task fault(input [8*30-1:0] what);
                begin
                    faults = faults + 1;
                    $display("FAIL divider %0d, gaps %0d, stalls %0d: %0s, byte %0d", DIVIDER, gaps, stalls, what, got);
                    if (faults > 20) $finish;
                end
            endtask

            function [7:0] word(input integer place);
                word = place * 151 + (place >> 8);
            endfunction

            function pause(input integer pattern);
                case (pattern)
                    0:       pause = 0;
                    1:       pause = $random(seed);
                    2:       pause = ($random(seed) & 255) != 0;
                    3:       pause = ($time / PERIOD / DIVIDER) & 512 ? 1'b1 : 1'b0;
                    default: pause = 1;
                endcase
            endfunction

            // One clock of noise.
            task noise;
                begin
                    rxd = ~rxd;
                    #(PERIOD - 20) rxd = ~rxd;
                end
            endtask

            // A bit, in one mix with noise where it hurts most, in its middle.
            task level(input value);
                begin
                    rxd = value;
                    if (gaps == 1) begin
                        #(bit_time / 2 - PERIOD / 2) noise;
                        #(bit_time - bit_time / 2 - PERIOD / 2 + 20);
                    end else #bit_time;
                end
            endtask

            task put(input [7:0] value, input stop);
                integer b;
                begin
                    level(1'b0);
                    for (b = 0; b < 8; b = b + 1) level(value[b]);
                    level(stop);
                    rxd = 1;
                end
            endtask

            always @(posedge clk) begin
                if (rx_valid && rx_ready && !rst) begin
                    if (got >= sent + 1 || rx_data !== word(got)) fault("wrong byte");
                    got = got + 1;
                end
                if (byte_lost) lost = lost + 1;
                #1 rx_ready = !pause(stalls);
            end

            // The whole line: a byte's ten bits, each looked at in its first and its last clock.
            always @(negedge txd) if (!rst) begin : listen
                integer b;
                reg [9:0] early, late;
                for (b = 0; b < 10; b = b + 1) begin
                    #(PERIOD / 4) early[b] = txd;
                    #(DIVIDER * PERIOD - PERIOD / 2) late[b] = txd;
                    if (b < 9) #(PERIOD / 4);
                end
                if (early !== late || early[0] !== 0 || early[9] !== 1 || early[8:1] !== word(on_line)) fault("line");
                on_line = on_line + 1;
            end

            task receive(input integer how);
                begin
                    stalls = how;
                    more   = 0;
                    while (sent < BYTES) begin
                        // A sender may have up to 16 bytes on their way when it is told to stop.
                        if (rts_n && more == 0) while (rts_n) #(PERIOD);
                        more = rts_n ? more - 1 : 16;
                        if (gaps == 1) #($random(seed) & 8191);
                        if (gaps == 2) begin
                            #(2 * bit_time) noise;
                            #(2 * bit_time) rxd = 0;
                            #(PERIOD * (DIVIDER / 2 - 2)) rxd = 1;
                            #(2 * bit_time);
                        end
                        put(word(sent), 1'b1);
                        sent = sent + 1;
                    end
                end
            endtask

            task until_all_came;
                begin
                    n = 0;
                    while (got < sent && n < 400000) @(posedge clk) n = n + 1;
                    repeat (40 * DIVIDER) @(posedge clk);
                    if (got != sent) fault("bytes missing");
                end
            endtask

            task test_receive;
                integer i;
                begin
                    mixes = 0;
                    for (i = 0; i < 36; i = i + ($test$plusargs("all") ? 1 : 5)) begin
                        mixes    = mixes + 1;
                        gaps     = i / 4 % 3;
                        skew     = i / 12 == 0 ? 1.0 : i / 12 == 1 ? 1.025 : 0.975;
                        bit_time = DIVIDER * PERIOD * skew;
                        {sent, got, lost} = 0;
                        receive(i % 4);
                        until_all_came;
                        if (lost != 0) fault("bytes lost");
                    end
                end
            endtask

            task test_damage;
                begin
                    {sent, got, lost, stalls} = 0;
                    bit_time = DIVIDER * PERIOD;
                    for (sent = 0; sent < 20; sent = sent + 1) begin
                        put(word(sent), 1'b1);
                        #1 if (sent % 4 == 1) begin
                            put(8'h5a, 1'b0);
                            #(bit_time);
                        end
                        if (sent % 4 == 3) begin
                            rxd = 0;
                            #(bit_time * (10 + 7 * sent)) rxd = 1;
                            #(bit_time);
                        end
                    end
                    until_all_came;
                    if (lost != 10) fault("damage not counted once each");
                    // Nobody takes the bytes and the sender does not stop.
                    {sent, got, lost} = 0;
                    stalls = 4;
                    for (n = 0; n < 100; n = n + 1) put(word(n), 1'b1);
                    repeat (DIVIDER) @(posedge clk);
                    sent = 100 - lost;
                    if (lost != 36) fault("bytes without room not counted");
                    stalls = 0;
                    until_all_came;
                end
            endtask

            task send_one;
                reg took;
                begin
                    tx_valid = 1;
                    tx_data  = word(sent);
                    took     = 0;
                    while (!took) begin
                        #1 took = tx_ready;
                        @(posedge clk) #1;
                    end
                    tx_valid = 0;
                    tx_data  = 8'hxx;
                    sent     = sent + 1;
                end
            endtask

            task test_send;
                begin
                    stalls = 0;
                    for (gaps = 0; gaps < 3; gaps = gaps + 1) begin
                        {sent, on_line} = 0;
                        begun = $time;
                        @(posedge clk) #1;
                        while (sent < BYTES) begin
                            if (gaps == 1 && $random(seed) & 1) repeat ($random(seed) & 63) @(posedge clk) #1;
                            if (gaps == 2 && $random(seed) & 1) begin
                                cts_n = 1;
                                repeat (12 * DIVIDER) @(posedge clk) #1;
                                n        = on_line;
                                tx_valid = 1;
                                tx_data  = 8'hxx;
                                repeat (12 * DIVIDER) @(posedge clk) #1;
                                if (on_line != n || txd !== 1) fault("sent against CTS#");
                                cts_n    = 0;
                                tx_valid = 0;
                            end
                            send_one;
                        end
                        if (gaps == 0 && ($time - begun) / PERIOD > BYTES * 10 * DIVIDER) fault("line not kept busy");
                        repeat (12 * DIVIDER) @(posedge clk) #1;
                        if (on_line != BYTES) fault("bytes not sent");
                    end
                end
            endtask

            initial begin
                {faults, seed, sent, got, lost, on_line, gaps, stalls} = 0;
                {rst, rxd, tx_valid, cts_n, rx_ready, finished[g]} = 6'b110000;
                tx_data = 8'hxx;
                wait (start[g]);
                repeat (4) @(posedge clk);
                #1 rst = 0;
                test_receive;
                if (faults == 0) $display("PASS divider %0d: %0d bytes under %0d mixes of gaps, noise, skew and stalls", DIVIDER, mixes * BYTES, mixes);
                test_damage;
                if (faults == 0) $display("PASS divider %0d: broken bytes, breaks, no room", DIVIDER);
                test_send;
                if (faults == 0) $display("PASS divider %0d: sending, with gaps and CTS#", DIVIDER);
                finished[g] = 1;
            end
        end
    endgenerate

    initial begin
        start = 1;
        wait (finished[0] === 1) start = 2;
        wait (finished[1] === 1) start = 4;
        wait (finished[2] === 1) $display("DONE");
        $finish;
    end
endmodule

`default_nettype wire
