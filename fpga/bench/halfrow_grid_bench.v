// The core's source coordinates of rows with a grid against the drawn grids of fpga/DATAPATH.md, by the CRC-32 of S of all rows,
// with and without pauses, at the least blanking; and the values of its worked example.
`default_nettype none

module halfrow_grid_bench;
    reg         clk, rst, enable, prepare, in_valid, in_start, step_write;
    reg  [11:0] width;
    reg  [12:0] centre2;
    reg  [10:0] last_row, prepare_row, table_entry;
    reg  [3:0]  shape;
    reg  [79:0] table_data;
    wire        prepared, row_short, row_long, row_unprepared;

    halfrow_core #(.TAPS(5), .TABLE_BANKS(1), .GRID(1)) core (
        .clk(clk), .rst(rst), .enable(enable), .width(width), .last_row(last_row), .centre2(centre2), .depth(2'd2),
        .prepare(prepare), .prepare_row(prepare_row), .prepare_bank(1'b0), .prepare_shape(shape), .prepared(prepared),
        .in_valid(in_valid), .in_start(in_start), .in_sample(12'd0),
        .out_valid(), .out_start(), .out_last(), .out_sample(),
        .row_short(row_short), .row_long(row_long), .row_unprepared(row_unprepared),
        .step_write(step_write), .node_write(1'b0), .table_bank(1'b0), .table_entry(table_entry),
        .table_data(table_data), .table_read(1'b0), .step_port(), .node_port_0(), .node_port_1());

    initial clk = 0;
    always #5 clk = !clk;

    // S of each column that begins to leave.
    integer     columns, errors;
    reg  [31:0] crc;
    wire [39:0] s = core.source.grid.parabolas.sum - 40'd16384;
    reg  [39:0] watched [0:63]; // of the first row's

    function [31:0] crc_word(input [31:0] before, input [63:0] word);
        integer b;
        begin
            crc_word = before;
            for (b = 0; b < 64; b = b + 1)
                crc_word = (crc_word >> 1) ^ ((crc_word[0] ^ word[b]) ? 32'hedb88320 : 32'd0);
        end
    endfunction

    always @(posedge clk) begin
        if (row_short || row_long || row_unprepared) errors = errors + 1;
        if (enable && core.source.reading) begin
            crc = crc_word(crc, {24'd0, s});
            if (columns < 64) watched[columns] = s;
            columns = columns + 1;
        end
    end

    task clock; begin @(posedge clk); #1; prepare = 0; end endtask

    reg pauses;
    task pixel_clock(input valid, input start);
        begin
            in_valid = valid; in_start = start;
            enable = 0;
            while (pauses && $random % 4 == 0) clock;
            enable = 1;
            clock;
            enable = 0;
        end
    endtask

    task reset;
        begin
            rst = 1; clock; rst = 0;
            columns = 0; errors = 0; crc = 32'hffffffff;
        end
    endtask

    task write_entry(input [10:0] entry, input [24:0] value);
        begin
            table_entry = entry; table_data = value;
            step_write = 1; clock; step_write = 0;
        end
    endtask

    task configure(input [11:0] columns_in, input integer height, input [12:0] centre, input [2:0] v, input integer k);
        begin
            width = columns_in; last_row = height - 1; centre2 = centre; shape = {k == 6, v};
        end
    endtask

    task enter(input integer row);
        integer j;
        for (j = 0; j < width; j = j + 1) begin
            if (j == 1 && row < last_row) begin prepare = 1; prepare_row = row + 1; end
            pixel_clock(1'b1, j == 0);
        end
    endtask

    // All rows of a frame; one that would have to wait for the core is an error.
    task frame(input integer blanking);
        integer row, k;
        begin
            prepare = 1; prepare_row = 0;
            for (k = 0; k < 100; k = k + 1) clock;
            for (row = 0; row <= last_row; row = row + 1) begin
                if (!prepared) errors = errors + 1;
                enter(row);
                for (k = 0; k < blanking; k = k + 1) pixel_clock(1'b0, 1'b0);
            end
            for (k = 0; k < width; k = k + 1) pixel_clock(1'b0, 1'b0);
        end
    endtask

    task drawn(input integer entries, input [31:0] seed, input wide);
        integer e;
        reg [31:0] product;
        for (e = 0; e < entries; e = e + 1) begin
            product = (e + seed) * 32'd2654435761;
            write_entry(e, wide ? product[31:7] : 25'd14680064 + product[31:12]);
        end
    endtask

    task expect_frame(input integer blanking, input [31:0] wanted);
        integer round;
        for (round = 0; round < 2; round = round + 1) begin
            pauses = round;
            reset; frame(blanking);
            if (errors != 0 || columns != width * (last_row + 1) || ~crc !== wanted)
                $display("FAIL W %0d, H %0d, pauses %0d: CRC %h for %h, %0d columns, %0d errors", width, last_row + 1, pauses, ~crc,
                         wanted, columns, errors);
        end
    endtask

    integer e;
    initial begin
        {rst, enable, prepare, in_valid, in_start, step_write, pauses} = 0;
        prepare_row = 0; table_entry = 0; table_data = 0;
        configure(12'd128, 9, 13'd127, 3'd1, 5);
        rst = 1; clock; clock; reset;

        drawn(42, 32'd0, 1'b0); expect_frame(32, 32'h45fae881);
        configure(12'd128, 70, 13'd100, 3'd6, 6);
        drawn(16, 32'd1, 1'b0); expect_frame(32, 32'h2617fe6d);
        configure(12'd130, 40, 13'd31, 3'd3, 5);
        drawn(49, 32'd2, 1'b1); expect_frame(32, 32'h21b519cd);
        configure(12'd192, 5, 13'd382, 3'd2, 6);
        drawn(20, 32'd3, 1'b1); expect_frame(0, 32'hc53e6168);
        $display("PASS the drawn grids, at the least blanking, with and without pauses");

        configure(12'd128, 9, 13'd127, 3'd1, 5);
        for (e = 0; e < 42; e = e + 1) write_entry(e, 25'd16777216);
        write_entry(1, 25'd16777216); write_entry(2, 25'd16785408); write_entry(3, 25'd16793600);
        write_entry(8, 25'd14680064); write_entry(9, 25'd14684160); write_entry(10, 25'd14696448);
        write_entry(15, 25'd14745600); write_entry(16, 25'd14745600); write_entry(17, 25'd14749696);
        pauses = 0; reset;
        prepare = 1; prepare_row = 3;
        for (e = 0; e < 100; e = e + 1) clock;
        last_row = 3; enter(3);
        for (e = 0; e < 128; e = e + 1) pixel_clock(1'b0, 1'b0);
        if (watched[0] !== 40'd2393939968 || watched[5] !== 40'd3569135488 || watched[32] !== 40'd9928351744)
            $display("FAIL the worked example: S[0] %0d, S[5] %0d, S[32] %0d", watched[0], watched[5], watched[32]);
        else $display("PASS the worked example");
        $display("DONE");
        $finish;
    end
endmodule

`default_nettype wire
