// The samples of a burst's rows, against the golden values of AT-SPEED.md. Rows follow each other without a clock between
// them, as the player has them at the least blanking; what waits is the generator alone.
`default_nettype none

module halfrow_content_bench;
    reg clk = 0;
    always #5 clk = !clk;

    reg         rst = 1, burst = 1, begins_row = 0, enters = 0, row_starts = 0;
    reg  [1:0]  depth = 2;
    reg  [31:0] seed = 1, gap_seed = 32'h01234567;
    reg  [15:0] frame = 0;
    reg  [11:0] row = 0;
    reg  [6:0]  column = 0;
    wire [31:0] first, draw;
    wire [11:0] sample;
    wire [3:0]  drawn;
    wire        gaps;

    halfrow_content content (
        .clk(clk), .burst(burst), .depth(depth), .seed(seed), .frame(frame), .row(row), .gap_seed(gap_seed),
        .first(first), .begins_row(begins_row), .enters(enters), .row_starts(row_starts), .column(column[3:0]),
        .draw(draw), .sample(sample));

    halfrow_gaps generator (
        .clk(clk), .rst(rst), .burst(burst), .seed(first), .restart(begins_row), .draw(enters), .drawn(drawn),
        .next(draw), .on(gaps));

    reg  [31:0]  crc;
    reg  [143:0] beginning; // the first twelve samples of a row, the first on top
    integer      bit_number, number, height, idle;

    task take(input [15:0] word);
        begin
            crc = crc ^ {16'd0, word};
            for (bit_number = 0; bit_number < 16; bit_number = bit_number + 1)
                crc = {1'b0, crc[31:1]} ^ (crc[0] ? 32'hEDB88320 : 32'd0);
        end
    endtask

    // A row of which the generator is set; with its last sample it is set for the next one.
    task enter_row(input integer samples);
        for (number = 0; number < samples; number = number + 1) begin
            enters = 1;
            row_starts = number == 0;
            column = number;
            if (number == 1) row = row + 1; // the next row is the one that may start
            begins_row = number == samples - 1;
            @(negedge clk);
            take({4'd0, sample});
            if (number < 12) beginning = {beginning[131:0], sample};
            enters = 0;
            begins_row = 0;
            repeat (idle) @(negedge clk);
        end
    endtask

    task set_for(input [31:0] wanted_seed, input [15:0] wanted_frame);
        begin
            seed = wanted_seed;
            frame = wanted_frame;
            row = 0;
            begins_row = 1;
            @(negedge clk) begins_row = 0;
        end
    endtask

    task expect_row(input [143:0] samples, input [31:0] content_crc);
        begin
            crc = 32'hFFFFFFFF;
            enter_row(64);
            if (beginning === samples && ~crc === content_crc)
                $display("PASS the row with the content %h", content_crc);
            else
                $display("FAIL the row with the content %h: %h, %h", content_crc, beginning, ~crc);
        end
    endtask

    task expect_frame(input integer columns, input integer rows, input [31:0] content_crc);
        begin
            crc = 32'hFFFFFFFF;
            for (height = 0; height < rows; height = height + 1) enter_row(columns);
            if (~crc === content_crc)
                $display("PASS the frame with the content %h", content_crc);
            else
                $display("FAIL the frame with the content %h: %h", content_crc, ~crc);
        end
    endtask

    initial begin
        @(negedge clk) rst = 0;
        for (idle = 0; idle < 3; idle = idle + 1) begin
            depth = 2;
            set_for(1, 0);
            expect_row({12'd4095, 12'd0, 12'd4095, 12'd4095, 12'd0, 12'd4095, 12'd4095, 12'd0, 12'd0, 12'd0, 12'd4095,
                        12'd0}, 32'h3f308f73);
            expect_row({12'd2192, 12'd2729, 12'd3419, 12'd1675, 12'd316, 12'd2892, 12'd2077, 12'd1755, 12'd4021, 12'd3317,
                        12'd2157, 12'd4039}, 32'h147085ad);
            expect_row({{8{12'd2128}}, {4{12'd64}}}, 32'h4de30b33);
            expect_row({6{12'd0, 12'd4095}}, 32'h4f53a7e2);
            depth = 1;
            set_for(32'hffffffff, 16'hffff);
            expect_frame(64, 16, 32'ha1dec90f);
            depth = 0;
            set_for(32'h12345678, 1);
            expect_frame(66, 33, 32'h9705d11d);
        end
        burst = 0;
        #1;
        if (first === gap_seed && !gaps)
            $display("PASS the seed of gaps without a burst");
        else
            $display("FAIL the seed of gaps without a burst: %h", first);
        $display("DONE");
        $finish;
    end
endmodule

`default_nettype wire
