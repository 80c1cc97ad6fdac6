// Plays every case of packets.py, with idle in front of the bytes and packets that are held for a while, and looks for exactly
// the events that must come of it. The receiver is reset between two cases, wherever it is then.
`default_nettype none

module halfrow_receiver_bench;
    localparam LONG = 600;  // bytes from which a case is played under one pattern only, in turn, since it takes long

    reg         clk, rst, rx_valid, packet_done;
    reg  [ 7:0] rx_data;
    reg  [11:0] packet_address;
    wire        rx_ready, packet_valid, crc_error, framing_error;
    wire [ 7:0] packet_kind, packet_flags, packet_session, packet_byte;
    wire [15:0] packet_sequence, packet_length;
    wire [31:0] packet_window;

    halfrow_receiver dut (
        .clk(clk), .rst(rst), .rx_valid(rx_valid), .rx_data(rx_data), .rx_ready(rx_ready),
        .packet_valid(packet_valid), .packet_kind(packet_kind), .packet_sequence(packet_sequence),
        .packet_length(packet_length), .packet_flags(packet_flags), .packet_session(packet_session),
        .packet_window(packet_window), .packet_done(packet_done), .packet_address(packet_address),
        .packet_byte(packet_byte), .crc_error(crc_error), .framing_error(framing_error)
    );

    reg  [8*64-1:0] name;
    reg  [8*256-1:0] cases;
    reg  [ 7:0] data   [0:65535];
    reg  [31:0] events [0:65535];
    integer     file, count, event_count, value, word, i, seed, idle, hold, faults, played, cases_read, stalled;
    reg         sent;
    integer     got;

    initial clk = 0;
    always #5 clk = ~clk;

    task fault(input [8*20-1:0] what);
        begin
            faults = faults + 1;
            $display("FAIL %0s: %0s (idle %0d, hold %0d)", name, what, idle, hold);
            if (faults > 20) $finish;
        end
    endtask

    // Between packets the receiver may look away for one clock, not for more.
    always @(posedge clk) begin
        stalled <= rst || rx_ready || packet_valid ? 0 : stalled + 1;
        if (stalled > 1) fault("rx_ready stays low");
        if (packet_valid && rx_ready) fault("rx_ready in hold");
    end

    task read_case;
        integer e, n;
        begin
            got = $fscanf(file, "%h %h", count, event_count);
            for (i = 0; i < count; i = i + 1) begin
                got     = $fscanf(file, "%h", value);
                data[i] = value;
            end
            word = 0;
            for (e = 0; e < event_count; e = e + 1) begin
                got          = $fscanf(file, "%h", value);
                events[word] = value;
                n            = value == 0 ? 6 : 0;
                for (i = 1; i <= n; i = i + 1) begin
                    got            = $fscanf(file, "%h", value);
                    events[word+i] = value;
                    if (i == 3) n = n + value;
                end
                word = word + n + 1;
            end
        end
    endtask

    task send;
        integer at;
        begin
            for (at = 0; at < count; at = at + 1) begin
                while (idle == 1 && $random(seed) & 1 || idle == 2 && $random(seed) & 3 || idle == 3 && !($random(seed) & 31)) begin
                    rx_valid = 0;
                    rx_data  = 8'hxx;
                    @(posedge clk) #1;
                end
                rx_valid = 1;
                rx_data  = data[at];
                got      = 0;
                while (!got) begin
                    got = rx_ready;
                    @(posedge clk) #1;
                end
            end
            rx_valid = 0;
            rx_data  = 8'hxx;
            repeat (4) @(posedge clk);
            #1 sent = 1;
        end
    endtask

    task look_at_packet;
        integer n, place;
        begin
            if (packet_kind !== events[word+1] || packet_sequence !== events[word+2] || packet_length !== events[word+3]
                || packet_flags !== events[word+4] || packet_session !== events[word+5] || packet_window !== events[word+6])
                fault("header");
            if (hold > 0) repeat (hold == 1 ? 3 : $random(seed) & 63) @(posedge clk) #1;
            for (n = 0; n < packet_length; n = n + 1) begin
                place          = hold == 1 ? packet_length - 1 - n : n;
                packet_address = place;
                @(posedge clk) #1;
                if (packet_byte !== events[word+7+place]) begin
                    fault("payload");
                    n = packet_length;
                end
            end
            packet_done = 1;
            @(posedge clk) #1;
            packet_done = 0;
            word = word + 7 + events[word+3];
        end
    endtask

    task watch;
        begin
            word = 0;
            while (event_count > 0 || !sent) begin
                if (!(packet_valid || crc_error || framing_error)) begin
                    if (sent && event_count > 0) begin
                        fault("event missing");
                        event_count = 0;
                    end else @(posedge clk) #1;
                end else begin
                    if (event_count == 0) fault("event too many");
                    else if ({packet_valid, crc_error, framing_error} !== 3'b100 >> events[word]) fault("wrong event");
                    event_count = event_count - 1;
                    if (packet_valid && events[word] == 0) look_at_packet;
                    else begin
                        word        = word + 1;
                        packet_done = packet_valid;
                        @(posedge clk) #1;
                        packet_done = 0;
                    end
                end
            end
        end
    endtask

    reg playing = 0;
    always @(posedge playing) send;

    task play;
        begin
            rst = 1;
            @(posedge clk) #1;
            rst  = 0;
            sent    = 0;
            playing = 1;
            watch;
            playing = 0;
            played = played + 1;
        end
    endtask

    initial begin
        seed        = 1;
        faults      = 0;
        rx_valid    = 0;
        packet_done = 0;
        stalled     = 0;
        rst         = 1;
        if (!$value$plusargs("cases=%s", cases)) $finish;
        for (idle = 0; idle < 4; idle = idle + 1)
            for (hold = 0; hold < 3; hold = hold + 1)
                if ($test$plusargs("all") || hold == idle % 3) begin
                    file       = $fopen(cases, "r");
                    played     = 0;
                    cases_read = 0;
                    while ($fscanf(file, "%s", name) == 1) begin
                        read_case;
                        if (count < LONG || (cases_read + idle) % 4 == 0) play;
                        cases_read = cases_read + 1;
                    end
                    $fclose(file);
                    if (faults == 0) $display("PASS %0d cases, idle pattern %0d, hold pattern %0d", played, idle, hold);
                end
        if (played > 0) $display("DONE");
        $finish;
    end
endmodule

`default_nettype wire
