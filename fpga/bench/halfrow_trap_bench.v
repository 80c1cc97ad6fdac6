// The trap with a frame's rows given to it close behind each other, or with clocks between their outputs: what it expects behind
// reset and behind EXPECTs of any span, which row it keeps of all that differ, and that it keeps it whatever comes then. The bench
// draws the rows' signatures, so that each bit of one may be the only one that is wrong.
`default_nettype none

module halfrow_trap_bench;
    localparam MAX_HEIGHT = 11, COLUMN_BITS = 6, PAYLOAD = 3, RANGE = 4, BUSY = 7;

    reg clk = 0;
    always #5 clk = !clk;

    reg         rst = 1, expect_start = 0, trap_start = 0, reply_begins = 0, reply_advance = 0;
    reg         under_way = 0, compares = 0, empty = 0, given = 0, last = 0, frame_left = 0;
    reg  [15:0] first = 0, count = 0;
    reg  [11:0] packet_length = 0, width = 64, height = 4, sample = 0, address = 0;
    reg  [31:0] row_signature = 0;
    reg  [7:0]  packet_byte;
    wire [11:0] sample_bytes = width + {1'b0, width[11:1]};
    wire        ready, advance, finished;
    wire [3:0]  refusal;
    wire [15:0] detail;
    wire [11:0] reply_length;
    wire [7:0]  value, sample_value;

    halfrow_trap #(.MAX_HEIGHT(MAX_HEIGHT), .COLUMN_BITS(COLUMN_BITS)) dut (
        .clk(clk), .rst(rst), .ready(ready), .expect_start(expect_start), .first(first), .count(count),
        .packet_length(packet_length), .advance(advance), .packet_byte(packet_byte), .trap_start(trap_start),
        .finished(finished), .refusal(refusal), .detail(detail), .reply_length(reply_length),
        .reply_begins(reply_begins), .reply_advance(reply_advance), .value(value), .sample_value(sample_value), .under_way(under_way),
        .compares(compares), .empty(empty), .width(width), .height(height), .sample_bytes(sample_bytes),
        .given(given), .last(last), .sample(sample), .row_signature(row_signature), .frame_left(frame_left));

    integer      seed = 1, faults = 0, i, n, burst, gaps, wrong_frame, wrong_row, waited;
    reg  [31:0]  signatures [0:MAX_HEIGHT-1];     // as they are expected
    reg  [7:0]   packet [0:4095];
    reg  [7:0]   got [0:255];
    reg          kept = 0;                        // and what of it must be told
    reg  [31:0]  kept_frame, kept_signature;
    reg  [15:0]  kept_row, kept_width;
    reg  [11:0]  kept_samples [0:63];
    reg  [11:0]  samples [0:63];

    // The receiver's buffer, which the dispatcher reads from the first signature on.
    always @(posedge clk) begin
        packet_byte <= packet[address];
        address     <= expect_start ? 12'd4 : address + {11'd0, advance};
    end

    task fail(input [8*60-1:0] what);
        begin
            faults = faults + 1;
            if (faults < 20) $display("FAIL burst %0d: %0s", burst, what);
        end
    endtask

    task expects(input [15:0] from, input [15:0] rows, input [11:0] bytes, input [3:0] code);
        begin
            @(negedge clk) {first, count, packet_length, expect_start} = {from, rows, bytes, 1'b1};
            @(negedge clk) expect_start = 0;
            waited = 0;
            while (!finished && waited < 400) begin
                @(negedge clk);
                waited = waited + 1;
            end
            if (refusal !== code || !finished) fail("the refusal of an EXPECT");
            if (detail !== (code == RANGE ? from : 16'd0)) fail("the detail of a refusal");
            @(negedge clk) if (finished || refusal !== 0) fail("an EXPECT is done once");
        end
    endtask

    // New signatures of some rows.
    task upload(input integer from, input integer rows);
        begin
            for (n = 0; n < rows; n = n + 1) begin
                signatures[from + n] = $random(seed);
                {packet[4*n+7], packet[4*n+6], packet[4*n+5], packet[4*n+4]} = signatures[from + n];
            end
            expects(from, rows, 4 + 4 * rows + ($random(seed) & 7), 0);
        end
    endtask

    task next_byte(input integer place);
        begin
            repeat (3) @(negedge clk);
            got[place] = value | sample_value;
            reply_advance = 1;
            @(negedge clk) reply_advance = 0;
        end
    endtask

    task asked;
        begin
            @(negedge clk) trap_start = 1;
            @(negedge clk) trap_start = 0;
            if (!finished || refusal !== 0) fail("a TRAP is done");
            if (reply_length !== (kept ? 13 + kept_width / 2 * 3 : 1)) fail("the reply's length");
            repeat ($random(seed) & 15) @(negedge clk);
            reply_begins = 1;
            @(negedge clk) reply_begins = 0;
            for (i = 0; i < reply_length; i = i + 1) next_byte(i);
            if (got[0] !== kept) fail("whether a row is kept");
            if (kept && {got[4], got[3], got[2], got[1]} !== kept_frame) fail("the frame");
            if (kept && {got[6], got[5]} !== kept_row) fail("the row");
            if (kept && {got[8], got[7]} !== kept_width) fail("the width");
            if (kept && {got[12], got[11], got[10], got[9]} !== kept_signature) fail("the signature");
            for (i = 0; kept && i < kept_width; i = i + 2)
                if ({got[15+i/2*3], got[14+i/2*3], got[13+i/2*3]} !== {kept_samples[i+1], kept_samples[i]}) fail("samples");
        end
    endtask

    // A row, with the bits of `wrong` other than they are expected. Its signature is there a clock behind its last output.
    task give_row(input [31:0] frame, input [11:0] row, input is_last, input [31:0] wrong);
        begin
            for (n = 0; n < width; n = n + 1) begin
                last = gaps; // without an output it means nothing
                if (gaps) repeat ($random(seed) & 1) @(negedge clk);
                {given, last} = {1'b1, n == width - 1};
                reply_begins = n == 20 && !kept; // a host asks meanwhile
                sample = $random(seed);
                samples[n] = sample;
                @(negedge clk);
                {given, reply_begins} = 2'b00;
            end
            last = 0;
            frame_left = is_last;
            row_signature = (row < MAX_HEIGHT ? signatures[row] : 0) ^ wrong;
            if (wrong != 0 && !kept && compares && row < height) begin
                kept = 1;
                kept_frame = frame;
                kept_row = row;
                kept_width = width;
                kept_signature = row_signature;
                for (n = 0; n < width; n = n + 1) kept_samples[n] = samples[n];
            end
            n = gaps ? $random(seed) & 7 : 0;
            repeat (n) @(negedge clk);
        end
    endtask

    task emptied;
        begin
            empty = 1;
            @(negedge clk) empty = 0;
            kept = 0;
        end
    endtask

    // Frames with one wrong row, and wrong ones behind it.
    task frames(input integer many, input integer rows);
        integer f, r;
        begin
            under_way = 1;
            for (f = 0; f < many; f = f + 1)
                for (r = 0; r < rows; r = r + 1)
                    give_row(f, r, r == rows - 1,
                             f * rows + r == wrong_frame * rows + wrong_row ? 1 << ($random(seed) & 31)
                             : f * rows + r > wrong_frame * rows + wrong_row && ($random(seed) & 1) ? $random(seed) | 1 : 0);
            repeat (20) @(negedge clk);
            under_way = 0;
        end
    endtask

    task passed(input [8*90-1:0] what);
        if (faults == 0) $display("PASS %0s", what);
    endtask

    initial begin
        burst = 0;
        gaps = 0;
        for (i = 0; i < MAX_HEIGHT; i = i + 1) signatures[i] = 0;
        for (i = 0; i < 4096; i = i + 1) packet[i] = 8'hff;
        repeat (3) @(negedge clk);
        rst = 0;
        @(negedge clk) if (ready) fail("ready before anything was cleared");
        repeat (4 * MAX_HEIGHT + 4) @(negedge clk);
        if (!ready) fail("ready");
        // Each row is expected to have 0.
        compares = 1;
        height = MAX_HEIGHT;
        for (burst = 0; burst < MAX_HEIGHT; burst = burst + 1) begin
            wrong_frame = 0;
            wrong_row = burst;
            emptied;
            frames(1, MAX_HEIGHT);
            asked;
        end
        passed("a row that was never uploaded is expected to have 0");
        upload(0, MAX_HEIGHT);
        expects(0, MAX_HEIGHT + 1, 4 + 4 * MAX_HEIGHT + 4, RANGE);
        expects(MAX_HEIGHT, 1, 8, RANGE);
        expects(MAX_HEIGHT, 0, 4, 0);
        expects(MAX_HEIGHT + 1, 0, 4, RANGE);
        expects(16'hfffe, 2, 12, RANGE);
        expects(16'h1000, 0, 4, RANGE);
        expects(0, 2, 11, PAYLOAD);
        expects(16'hffff, 1, 7, PAYLOAD);
        expects(0, 16'h4001, 8, PAYLOAD);
        expects(0, 1024, 4080, PAYLOAD);
        under_way = 1;
        expects(16'hffff, 1, 8, BUSY);
        expects(0, 1, 8, BUSY);
        expects(0, 1, 7, PAYLOAD);
        under_way = 0;
        passed("EXPECTs that are refused change nothing");
        for (burst = 0; burst < 300; burst = burst + 1) begin
            gaps = $random(seed) & 1;
            width = 64 - 2 * ($random(seed) & 7);
            height = 1 + ($random(seed) & 7);
            n = $random(seed) & 7;
            if (burst & 1) upload(n, 1 + ($random(seed) & 3));
            // Rows from the height on are not compared.
            wrong_frame = $random(seed) & 3;
            wrong_row = $random(seed) & 7;
            i = burst & 3;
            compares = i != 0;
            if (compares) emptied;
            frames(3, height + ($random(seed) & 1));
            if (burst & 4) upload(0, 1);
            width = 64;
            asked;
            if (burst & 8) asked;
        end
        passed("drawn bursts: the first row that differs is kept, up to the next burst that is compared");
        // Emptied at each clock behind a wrong row's last output, nothing is left.
        gaps = 0;
        compares = 1;
        height = 2;
        for (burst = 0; burst < 12; burst = burst + 1) begin
            emptied;
            give_row(0, 0, 0, 0);
            give_row(0, 1, 1, 1);
            repeat (burst) @(negedge clk);
            emptied;
            repeat (20) @(negedge clk);
            asked;
            wrong_frame = 9;
            frames(2, 2);
            asked;
        end
        passed("what is emptied stays empty, and the next row is row 0");
        if (faults != 0) $display("FAIL %0d faults", faults);
        $display("DONE");
        $finish;
    end
endmodule

`default_nettype wire
