// Both clients offer the packets of packets.py in different ways, and what reaches the link must be their bytes, in order and
// nothing else. Whatever is not valid is driven with x, so that it shows when it is used.
`default_nettype none

module halfrow_sender_bench;
    localparam LIMIT = 1024;

    reg         clk, rst, tx_ready;
    reg  [ 1:0] valid, flag, byte_valid;  // bit 0: the reply client, 1: the row client
    reg  [ 7:0] reply_kind, reply_session, reply_byte, row_kind, row_session, row_byte;
    reg  [15:0] reply_sequence, reply_length, row_sequence, row_length;
    reg  [31:0] window;
    wire [ 1:0] taken, byte_ready;
    wire        tx_valid, idle;
    wire [ 7:0] tx_data;

    halfrow_sender dut (
        .clk(clk), .rst(rst),
        .reply_valid(valid[0]), .reply_kind(reply_kind), .reply_sequence(reply_sequence), .reply_length(reply_length),
        .reply_flag(flag[0]), .reply_session(reply_session), .reply_taken(taken[0]), .reply_byte_valid(byte_valid[0]),
        .reply_byte(reply_byte), .reply_byte_ready(byte_ready[0]),
        .row_valid(valid[1]), .row_kind(row_kind), .row_sequence(row_sequence), .row_length(row_length),
        .row_flag(flag[1]), .row_session(row_session), .row_taken(taken[1]), .row_byte_valid(byte_valid[1]),
        .row_byte(row_byte), .row_byte_ready(byte_ready[1]),
        .window(window), .tx_valid(tx_valid), .tx_data(tx_data), .tx_ready(tx_ready), .idle(idle)
    );

    reg  [8*64-1:0]  name;
    reg  [8*256-1:0] cases;
    reg  [95:0] fields  [0:LIMIT-1];  // window, session, flags, length, sequence, kind
    integer     payload [0:LIMIT-1];  // where it begins in `bytes`
    reg  [ 7:0] bytes   [0:262143];
    reg  [ 7:0] wanted  [0:262143];
    integer     total, wanted_total, bytes_total;
    integer     file, got, value, count, i, seed, faults, order, gaps, stalls, clocks;
    integer     next_offer, next_byte, left, out;
    reg         sender_of;            // the client whose payload is under way
    reg         row_header;           // the header of a row may still be under way, so its fields stay
    reg         was_offered;
    reg  [ 7:0] was_data;

    initial clk = 0;
    always #5 clk = ~clk;

    task fault(input [8*30-1:0] what);
        begin
            faults = faults + 1;
            $display("FAIL %0s at byte %0d (order %0d, gaps %0d, stalls %0d)", what, out, order, gaps, stalls);
            if (faults > 20) $finish;
        end
    endtask

    task load;
        begin
            file         = $fopen(cases, "r");
            total        = 0;
            bytes_total  = 0;
            wanted_total = 0;
            while ($fscanf(file, "%s", name) == 1) begin
                for (i = 0; i < 6; i = i + 1) begin
                    got = $fscanf(file, "%h", value);
                    case (i)
                        0: fields[total][7:0] = value;
                        1: fields[total][23:8] = value;
                        2: fields[total][39:24] = value;
                        3: fields[total][47:40] = value;
                        4: fields[total][55:48] = value;
                        default: fields[total][87:56] = value;
                    endcase
                    if (i == 2) count = value;
                end
                payload[total] = bytes_total;
                for (i = 0; i < count; i = i + 1) begin
                    got                  = $fscanf(file, "%h", value);
                    bytes[bytes_total+i] = value;
                end
                bytes_total = bytes_total + count;
                got         = $fscanf(file, "%h", count);
                for (i = 0; i < count; i = i + 1) begin
                    got                    = $fscanf(file, "%h", value);
                    wanted[wanted_total+i] = value;
                end
                wanted_total = wanted_total + count;
                total        = total + 1;
            end
            $fclose(file);
        end
    endtask

    `include "pause.vh"

    // Which client has packet n: all replies, all rows, in turns, or in turns with both offered at once.
    function owner(input integer n);
        owner = order == 0 ? 1'b0 : order == 1 ? 1'b1 : n & 1;
    endfunction

    task offer(input integer n);
        begin
            valid[owner(n)] = 1;
            flag[owner(n)]  = fields[n][40];
            window          = fields[n][87:56];
            if (owner(n)) {row_session, row_length, row_sequence, row_kind} = {fields[n][55:48], fields[n][39:0]};
            else {reply_session, reply_length, reply_sequence, reply_kind} = {fields[n][55:48], fields[n][39:0]};
        end
    endtask

    task withdraw;
        begin
            valid[sender_of] = 0;
            flag[sender_of]  = 1'bx;
            window           = 32'hx;
            if (sender_of) {row_header, flag[1]} = {1'b1, fields[next_offer-1][40]};
            else {reply_session, reply_length, reply_sequence, reply_kind} = 48'hx;
        end
    endtask

    task edge_of_clock;
        reg [1:0] took, moved;
        begin
            if (row_header && (byte_ready[1] || idle)) begin
                row_header = 0;
                flag[1]    = 1'bx;
                {row_session, row_length, row_sequence, row_kind} = 48'hx;
            end
            took        = taken;
            moved       = byte_valid & byte_ready;
            was_offered = tx_valid && !tx_ready;
            was_data    = tx_data;
            if (took & ~valid || took == 3) fault("taken without need");
            if (tx_valid && tx_ready) begin
                if (out >= wanted_total || tx_data !== wanted[out]) fault("wrong byte");
                out = out + 1;
            end
            @(posedge clk) #1;
            clocks = clocks + 1;
            if (was_offered && (!tx_valid || tx_data !== was_data)) fault("tx not stable");
            if (moved) begin
                next_byte = next_byte + 1;
                left      = left - 1;
            end
            if (took) begin
                sender_of = took[1];
                if (sender_of !== owner(next_offer)) fault("wrong client");
                next_byte  = payload[next_offer];
                left       = fields[next_offer][39:24];
                next_offer = next_offer + 1;
                withdraw;
            end
        end
    endtask

    task drive;
        begin
            tx_ready = !pause(stalls, clocks);
            if (next_offer < total && !valid && left == 0 && !row_header && !pause(gaps, clocks)) begin
                offer(next_offer);
                if (order == 3 && !owner(next_offer) && next_offer + 1 < total) offer(next_offer + 1);
            end
            // With both offered the common window is that of the one whose turn it is.
            if (valid) window = fields[next_offer][87:56];
            byte_valid             = 0;
            {reply_byte, row_byte} = 16'hx;
            if (left > 0 && !pause(gaps, clocks)) begin
                byte_valid[sender_of] = 1;
                if (sender_of) row_byte = bytes[next_byte];
                else reply_byte = bytes[next_byte];
            end
        end
    endtask

    initial begin
        seed   = 1;
        faults = 0;
        if (!$value$plusargs("cases=%s", cases)) $finish;
        load;
        for (order = 0; order < 4; order = order + 1)
            for (gaps = 0; gaps < 4; gaps = gaps + 1)
                for (stalls = 0; stalls < 4; stalls = stalls + 1)
                    if ($test$plusargs("all") ? (order + gaps + stalls) % 4 == 0 : gaps == order && stalls == 3 - order) begin
                        {valid, byte_valid, next_offer, next_byte, left, out, clocks, sender_of, row_header} = 0;
                        rst = 1;
                        @(posedge clk) #1;
                        rst = 0;
                        while ((out < wanted_total || !idle) && clocks < 40 * wanted_total) begin
                            drive;
                            #1 edge_of_clock;
                        end
                        repeat (300) begin
                            drive;
                            #1 edge_of_clock;
                        end
                        if (out != wanted_total || !idle) begin
                            fault("bytes missing");
                            $finish;
                        end
                        if (gaps == 0 && stalls == 0 && clocks > wanted_total + 4 * total + 600) fault("too slow");
                        if (faults == 0)
                            $display("PASS %0d packets, order %0d, gaps %0d, stalls %0d: %0d bytes in %0d clocks", total, order,
                                     gaps, stalls, out, clocks);
                    end
        if (total > 0) $display("DONE");
        $finish;
    end
endmodule

`default_nettype wire
