// Plays a sensor's frames through camera input, core and camera output: every sample, LINE_VALID and FRAME_VALID must come
// out exactly W/2 + L pixel clocks later, and what a hostile sensor spoils must not reach the next good row.
// +full plays a whole 1080p frame with the MT9P031's timing, otherwise its first rows are played.
`default_nettype none

module halfrow_camera_bench;
    localparam LATENCY = 12;
    localparam LINE = 4096;                       // clocks that the expectations reach back

    reg         clk = 0, rst = 1, fv = 0, lv = 0;
    reg  [11:0] data = 0;
    integer     width = 64, height = 4, blanking = 30;

    always #5 clk = !clk;

    reg         step_write = 0, node_write = 0;
    reg  [10:0] entry = 0;
    reg  [79:0] table_data = 0;

    wire        prepare, prepare_bank, prepared, in_valid, in_start, frame_valid, missed, short, long, unprepared;
    wire [10:0] prepare_row;
    wire [11:0] in_sample, out_sample, isp_data;
    wire        out_valid, out_start, out_last, isp_fv, isp_lv;

    halfrow_camera_input camera_input (
        .clk(clk), .rst(rst), .height(height[11:0]), .bank(1'b0),
        .camera_frame_valid(fv), .camera_line_valid(lv), .camera_data(data),
        .prepare(prepare), .prepare_row(prepare_row), .prepare_bank(prepare_bank), .prepared(prepared),
        .in_valid(in_valid), .in_start(in_start), .in_sample(in_sample),
        .frame_valid(frame_valid), .row_missed(missed));

    halfrow_core core (
        .clk(clk), .rst(rst), .enable(1'b1), .width(width[11:0]), .last_row(11'd0), .centre2(width[12:0] - 13'd1), .depth(2'd2),
        .prepare(prepare), .prepare_row(prepare_row), .prepare_bank(prepare_bank), .prepare_shape(4'd0),
        .prepared(prepared),
        .in_valid(in_valid), .in_start(in_start), .in_sample(in_sample),
        .out_valid(out_valid), .out_start(out_start), .out_last(out_last), .out_sample(out_sample),
        .row_short(short), .row_long(long), .row_unprepared(unprepared),
        .step_write(step_write), .node_write(node_write), .table_bank(1'b0), .table_entry(entry),
        .table_data(table_data), .table_read(1'b0), .step_port(), .node_port_0(), .node_port_1());

    halfrow_camera_output #(.TAPS(7)) camera_output (
        .clk(clk), .rst(rst), .width(width[11:0]), .frame_valid(frame_valid),
        .out_valid(out_valid), .out_sample(out_sample),
        .isp_frame_valid(isp_fv), .isp_line_valid(isp_lv), .isp_data(isp_data));

    // The tables: all nodes 0, so that an output is the sample at its base column, and a step for each row of its own.
    reg stretched = 0;

    function [24:0] step(input integer row);
        step = stretched ? 25'h1000000 - row * 25'd70001 : 25'h1000000;
    endfunction

    function [11:0] sample(input integer frame, input integer row, input integer column);
        reg [31:0] mixed;
        begin
            mixed = (frame * 4999 + row * 2593 + column + 1) * 32'd2654435761;
            sample = mixed[31:20];
        end
    endfunction

    function [11:0] corrected(input integer frame, input integer row, input integer column);
        reg signed [47:0] position;
        integer n, base;
        begin
            position = (width - 1) * 48'sd16777216 + (2 * column - width + 1) * $signed({23'd0, step(row)});
            n = (position + 48'sd2048) >>> 25;
            base = n - (n + column) % 2;
            corrected = sample(frame, row, base < 0 ? 1 : base);
        end
    endfunction

    // What each clock's inputs must bring: {known, FRAME_VALID, LINE_VALID, data}.
    reg  [14:0] expected [0:LINE-1];
    reg  [14:0] now, due;
    integer     t = 0, errors = 0, rows_seen = 0, faults = 0, mishaps = 0, i;

    always @(posedge clk) begin
        expected[t % LINE] = now;
        if (t >= width / 2 + LATENCY && !rst) begin
            due = expected[(t - width / 2 - LATENCY) % LINE];
            if (isp_fv !== due[13] || (due[14] && (isp_lv !== due[12] || isp_data !== due[11:0]))) begin
                errors = errors + 1;
                if (errors < 4)
                    $display("clock %0d: FV %b LV %b data %h, due %b %b %h", t, isp_fv, isp_lv, isp_data,
                        due[13], due[12], due[11:0]);
            end
            if (out_start) rows_seen = rows_seen + 1;
        end
        if (short || long || missed) faults = faults + 1;
        if (unprepared) mishaps = mishaps + 1;
        t = t + 1;
    end

    task tick(input frame_line, input line, input [11:0] value, input [14:0] expectation);
        begin
            fv = frame_line; lv = line; data = value; now = expectation;
            @(negedge clk);
        end
    endtask

    task idle(input integer clocks, input frame_line, input taken);
        repeat (clocks) tick(frame_line, 1'b0, 12'hbad, {1'b1, frame_line && taken, 13'd0});
    endtask

    // A row of `columns` samples; a good one is due whole, of a spoilt one nothing is, up to the time of its last column.
    task row(input integer frame, input integer number, input integer columns, input taken, input good);
        integer c;
        for (c = 0; c < (columns > width || good ? columns : width); c = c + 1)
            tick(1'b1, c < columns, sample(frame, number, c),
                !taken ? 15'h4000 : good ? {3'b111, corrected(frame, number, c)} : 15'h2000);
    endtask

    task frame(input integer number, input integer rows);
        integer r;
        begin
            idle(blanking / 2 + 24, 1'b1, 1'b1);
            for (r = 0; r < rows; r = r + 1) begin
                if (r < height) row(number, r, width, 1'b1, 1'b1);
                else repeat (width) tick(1'b1, 1'b1, 12'h123, 15'h6000);
                idle(blanking, 1'b1, 1'b1);
            end
            idle(1, 1'b0, 1'b0);
        end
    endtask

    task load_tables;
        begin
            for (i = 0; i < 2048; i = i + 1) begin
                entry = i; step_write = 1; node_write = i < 65;
                table_data = {55'd0, step(i)};
                if (i < 65) begin step_write = 0; table_data = 80'd0; end
                idle(1, 1'b0, 1'b0);
            end
            node_write = 0;
            for (i = 0; i < 65; i = i + 1) begin
                entry = i; step_write = 1; table_data = {55'd0, step(i)};
                idle(1, 1'b0, 1'b0);
            end
            step_write = 0;
        end
    endtask

    // Forgets what is due, as a reset or a change of size does.
    task restart;
        begin
            for (i = 0; i < LINE; i = i + 1) expected[i] = 15'h4000;
            rst = 1; now = 15'h4000;
            @(negedge clk);
            rst = 0;
        end
    endtask

    task settle(input [8*64-1:0] what, input integer faults_due);
        begin
            idle(width / 2 + LATENCY + 4, 1'b0, 1'b0);
            if (errors == 0 && faults == faults_due && mishaps == 0) $display("PASS %0s", what);
            else $display("FAIL %0s: %0d clocks differ, %0d faults seen of %0d", what, errors, faults, faults_due);
            errors = 0; faults = 0; mishaps = 0;
        end
    endtask

    task size(input integer columns, input integer rows, input integer between, input bent);
        begin
            fv = 0; lv = 0;
            width = columns; height = rows; blanking = between; stretched = bent;
            rst = 1;
            load_tables;
            restart;
            idle(1, 1'b0, 1'b0);
            rows_seen = 0;
        end
    endtask

    task sensor_frame;
        begin
            size(1920, 1080, 900, 1'b0);
            frame(1, $test$plusargs("full") ? 1080 : 6);
            idle(9 * 2820, 1'b0, 1'b0);
            settle("1920 x 1080, 900 blanking: D on every row", 0);
            $display("     %0d rows, each %0d clocks late", rows_seen, width / 2 + LATENCY);
        end
    endtask

    task good_frames;
        begin
            size(64, 9, 30, 1'b1);
            frame(1, 9); frame(2, 9);
            settle("rows use their own steps, frame after frame", 0);
            size(64, 9, 1, 1'b1);
            frame(1, 9); frame(2, 9); frame(3, 9);
            settle("one clock between rows, one between frames", 0);
            size(2048, 3, 1, 1'b1);
            frame(1, 3); frame(2, 3);
            settle("2048 columns, one clock between rows", 0);
            size(64, 1, 1, 1'b1);
            frame(1, 1); frame(2, 1);
            settle("frames of one row", 0);
        end
    endtask

    task spoilt_rows;
        begin
            size(96, 5, 40, 1'b1);
            idle(60, 1'b1, 1'b1);
            row(4, 0, 96, 1'b1, 1'b1); idle(40, 1'b1, 1'b1);
            row(4, 1, 90, 1'b1, 1'b0); idle(40, 1'b1, 1'b1);
            row(4, 2, 96, 1'b1, 1'b1); idle(40, 1'b1, 1'b1);
            row(4, 3, 1, 1'b1, 1'b0); idle(40, 1'b1, 1'b1);
            row(4, 4, 96, 1'b1, 1'b1); idle(2, 1'b1, 1'b1);
            idle(1, 1'b0, 1'b0);
            settle("rows too short, the next exact", 2);

            idle(60, 1'b1, 1'b1);
            row(5, 0, 96, 1'b1, 1'b1); idle(40, 1'b1, 1'b1);
            for (i = 0; i < 140; i = i + 1)
                tick(1'b1, 1'b1, sample(5, 1, i), i < 96 ? 15'h2000 : 15'h6000);
            idle(40, 1'b1, 1'b1);
            row(5, 2, 96, 1'b1, 1'b1); idle(40, 1'b1, 1'b1);
            idle(1, 1'b0, 1'b0);
            settle("a row too long, the next exact", 1);

            idle(60, 1'b1, 1'b1);
            row(6, 0, 10, 1'b1, 1'b0);
            for (i = 0; i < 8; i = i + 1) begin
                tick(1'b1, 1'b0, 12'd0, 15'h2000);
                tick(1'b1, 1'b0, 12'd0, 15'h2000);
                tick(1'b1, 1'b1, 12'd0, 15'h2000);
            end
            repeat (96) tick(1'b1, 1'b0, 12'd0, 15'h2000);
            idle(1, 1'b0, 1'b0);
            faults = 0;
            frame(7, 5);
            settle("LINE_VALID that flickers, the next frame exact", 0);
        end
    endtask

    task spoilt_frames;
        begin
            size(64, 4, 30, 1'b1);
            rst = 1; fv = 1; now = 15'h4000;
            @(negedge clk);
            rst = 0;
            idle(40, 1'b1, 1'b0);
            row(8, 2, 64, 1'b0, 1'b0); idle(30, 1'b1, 1'b0);
            row(8, 3, 64, 1'b0, 1'b0); idle(30, 1'b1, 1'b0);
            idle(1, 1'b0, 1'b0);
            frame(9, 4);
            settle("FRAME_VALID high behind reset, the next frame exact", 0);

            idle(54, 1'b1, 1'b1);
            row(10, 0, 64, 1'b1, 1'b1); idle(30, 1'b1, 1'b1);
            for (i = 0; i < 64; i = i + 1)
                tick(i < 20, 1'b1, sample(10, 1, i), i < 20 ? 15'h2000 : 15'h4000);
            frame(11, 4);
            settle("FRAME_VALID falls in mid row, the next frame exact", 1);

            frame(12, 2); frame(13, 4); frame(14, 9); frame(15, 4);
            settle("fewer rows, then more, the next frame exact", 0);

            idle(54, 1'b1, 1'b1);
            row(16, 0, 64, 1'b1, 1'b1); idle(30, 1'b1, 1'b1);
            for (i = 0; i < 50; i = i + 1) tick(1'b1, 1'b1, sample(16, 1, i), 15'h2000);
            lv = 1;
            restart;
            repeat (20) tick(1'b1, 1'b1, 12'h777, 15'h4000);
            idle(30, 1'b1, 1'b0);
            row(16, 2, 64, 1'b0, 1'b0); idle(30, 1'b1, 1'b0);
            idle(1, 1'b0, 1'b0);
            frame(17, 4);
            settle("reset in mid row, the next frame exact", 0);

            repeat (64) tick(1'b0, 1'b1, 12'h555, 15'h4000);
            idle(5, 1'b0, 1'b0);
            frame(18, 4);
            settle("LINE_VALID outside a frame", 0);
        end
    endtask

    integer seed = 1;

    function integer draw(input integer from, input integer to);
        draw = from + $unsigned($random(seed)) % (to - from + 1);
    endfunction

    // One row of a frame: good three times in four, else too short, or too long.
    task any_row(input integer number, input integer r);
        integer c, extra;
        case (draw(0, 7))
            0: row(number, r, draw(1, width - 1), 1'b1, 1'b0);
            1: begin
                extra = draw(1, 90);
                for (c = 0; c < width + extra; c = c + 1)
                    tick(1'b1, 1'b1, sample(number, r, c), c < width ? 15'h2000 : 15'h6000);
            end
            default: row(number, r, width, 1'b1, 1'b1);
        endcase
    endtask

    task any_frame(input integer number);
        integer r, rows, cut, c;
        begin
            rows = draw(0, height + 2);
            idle(draw(24, 90), 1'b1, 1'b1);
            for (r = 0; r < rows; r = r + 1) begin
                if (r < height) any_row(number, r);
                else repeat (draw(1, 2 * width)) tick(1'b1, 1'b1, 12'h123, 15'h6000);
                idle(draw(24, 90), 1'b1, 1'b1);
            end
            cut = draw(0, 2 * width);
            if (cut < width && rows < height)      // FRAME_VALID falls in mid row
                for (c = 0; c < width + 30; c = c + 1)
                    tick(c < cut, c < cut + 9, 12'h321, c < cut ? 15'h2000 : 15'h4000);
            idle(draw(1, 200), 1'b0, 1'b0);
        end
    endtask

    task any_frames;
        integer k, n;
        begin
            for (k = 0; k < 12; k = k + 1) begin
                size(2 * draw(32, 60), draw(1, 5), 30, 1'b1);
                for (n = 0; n < 12; n = n + 1) any_frame(20 + 12 * k + n);
                frame(200 + k, height);
                idle(width / 2 + LATENCY + 4, 1'b0, 1'b0);
            end
            faults = 0;
            settle("144 drawn frames of all kinds, good rows exact", 0);
        end
    endtask

    initial begin
        if (!$value$plusargs("seed=%d", seed)) seed = 1;
        for (i = 0; i < LINE; i = i + 1) expected[i] = 15'h4000;
        now = 15'h4000;
        @(negedge clk);
        good_frames;
        spoilt_rows;
        spoilt_frames;
        any_frames;
        sensor_frame;
        $display("DONE");
        $finish;
    end
endmodule

`default_nettype wire
