// The whole bridge with a sensor on it: frames come through with the power-up tables, test frames of a session take their
// place at once, and behind the session the next whole frame comes through, D clocks late.
`default_nettype none

module halfrow_bridge_bench;
    localparam WIDTH = 64, HEIGHT = 4, LATENCY = 12, DELAY = WIDTH / 2 + LATENCY, PERIOD = 110;

    reg         clk = 0, rst = 1, rx_valid = 0, fv = 0, lv = 0;
    reg  [7:0]  rx_data = 0;
    reg  [11:0] data = 0;
    wire        rx_ready, tx_valid, isp_fv, isp_lv, fault, session_open, packet_seen, quiet;
    wire [7:0]  tx_data;
    wire [11:0] isp_data;

    always #5 clk = !clk;

    halfrow_bridge #(.MAX_WIDTH(WIDTH), .MAX_HEIGHT(HEIGHT)) dut (
        .clk(clk), .rst(rst), .rx_valid(rx_valid), .rx_data(rx_data), .rx_ready(rx_ready),
        .tx_valid(tx_valid), .tx_data(tx_data), .tx_ready(1'b1), .millisecond(1'b0), .clock_source(8'd1),
        .clock_hz(32'd96000000), .serial(64'd0),
        .camera_frame_valid(fv), .camera_line_valid(lv), .camera_data(data),
        .isp_frame_valid(isp_fv), .isp_line_valid(isp_lv), .isp_data(isp_data), .camera_fault(fault),
        .session_open(session_open), .packet_seen(packet_seen), .quiet(quiet));

    // The sensor never stops; HEIGHT rows a frame and two rows of blanking.
    integer at = 0, line = 0;

    always @(negedge clk) begin
        fv = line < HEIGHT && (line > 0 || at >= 4) && (line < HEIGHT - 1 || at < PERIOD - 4);
        lv = line < HEIGHT && at >= 20 && at < 20 + WIDTH;
        data = $random;
        at = at + 1;
        if (at == PERIOD) begin
            at = 0;
            line = (line + 1) % (HEIGHT + 2);
        end
    end

    // The same signals D clocks later, which the image processor must get while its frames are whole.
    reg  [13:0] late [0:63];
    reg  [13:0] due, got;
    integer     t = 0, equal_rows = 0, wrong = 0, shown = 0, dark = 0, faults = 0;
    reg         shows = 0, row_good = 1, fv_before = 0;

    always @(posedge clk) begin
        due = late[(t + 64 - DELAY) % 64];
        if (!due[12]) due[11:0] = 0;
        late[t % 64] = {fv, lv, data};
        got = {isp_fv, isp_lv, isp_data};
        if (isp_fv && !fv_before) begin
            shows = 1;
            shown = shown + 1;
        end
        if (rst) wrong = 0;
        else if (shows ? got !== due && !session_open : got !== 14'd0) wrong = wrong + 1;
        if (shows && got[13] && isp_lv && got === due) equal_rows = equal_rows + 1;
        if (!isp_fv) shows = 0;
        if (session_open && isp_fv) dark = dark + 1;
        if (fault) faults = faults + 1;
        fv_before = isp_fv;
        t = t + 1;
    end

    reg  [7:0]  bytes [0:63];
    reg  [31:0] crc;
    integer     answers = 0, zero_before = 0;

    always @(posedge clk) if (tx_valid) begin
        if (tx_data != 0 && zero_before) answers = answers + 1;
        zero_before = tx_data == 0;
    end

    task send(input [7:0] value);
        begin
            @(negedge clk);
            rx_valid = 1;
            rx_data = value;
            @(posedge clk);
            while (!rx_ready) @(posedge clk);
            @(negedge clk);
            rx_valid = 0;
        end
    endtask

    // Sends a header of the kind and session with `length` bytes of payload, which lie behind it in `bytes`.
    task packet(input [7:0] kind, input [7:0] session, input integer length);
        integer i, k, piece;
        begin
            for (i = 0; i < 12; i = i + 1) bytes[i] = 0;
            bytes[0] = 1; bytes[1] = kind; bytes[4] = length; bytes[7] = session;
            crc = 32'hffffffff;
            for (i = 0; i < 12 + length; i = i + 1) begin
                crc = crc ^ {24'd0, bytes[i]};
                for (k = 0; k < 8; k = k + 1) crc = crc[0] ? (crc >> 1) ^ 32'hedb88320 : crc >> 1;
            end
            crc = ~crc;
            for (i = 0; i < 4; i = i + 1) bytes[12 + length + i] = crc[8*i +: 8];
            send(8'd0);
            i = 0;
            while (i <= 16 + length) begin
                piece = 0;
                while (i + piece < 16 + length && bytes[i + piece] != 0) piece = piece + 1;
                send(piece + 1);
                for (k = 0; k < piece; k = k + 1) send(bytes[i + k]);
                i = i + piece + 1;
            end
            send(8'd0);
        end
    endtask

    task judge(input [8*64-1:0] what, input good);
        begin
            if (good && wrong == 0 && faults == 0) $display("PASS %0s", what);
            else $display("FAIL %0s: %0d clocks wrong, %0d samples equal, %0d frames, %0d faults", what, wrong,
                equal_rows, shown, faults);
            wrong = 0; equal_rows = 0; shown = 0; dark = 0;
        end
    endtask

    integer n;

    initial begin
        repeat (3) @(negedge clk);
        rst = 0;
        wait (shown == 1);
        wait (shown == 4);
        judge("behind reset whole frames come through", equal_rows == 3 * WIDTH * HEIGHT);

        wait (isp_lv);
        repeat (7) @(negedge clk);
        for (n = 0; n < 11; n = n + 1) bytes[12 + n] = n + 1;
        bytes[20] = 1; bytes[21] = 1; bytes[22] = 0;
        packet(8'h00, 8'd0, 11);
        wait (session_open);
        repeat (2) @(negedge clk);               // FRAME_VALID falls in the next clock
        wrong = 0; dark = 0; shown = 0;
        repeat (3 * 6 * PERIOD) @(negedge clk);
        judge("a session takes the core from the sensor", dark == 0 && shown == 0 && answers == 1);

        for (n = 0; n < 5; n = n + 1) bytes[12 + n] = 0;
        bytes[12] = 1;
        packet(8'h03, dut.session, 5);
        wait (!session_open);
        wrong = 0; equal_rows = 0;
        wait (shown == 3);
        judge("behind it whole frames come through again", equal_rows == 2 * WIDTH * HEIGHT && answers == 2);
        $display("DONE");
        $finish;
    end

    initial begin
        repeat (60000) @(negedge clk);
        $display("FAIL it waits for ever");
        $finish;
    end
endmodule

`default_nettype wire
