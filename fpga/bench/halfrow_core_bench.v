// The corrector against the golden values of fpga/DATAPATH.md: rows of 64 samples at every blanking from 0 to 8, with and without
// pauses, five and seven taps; the delay of every sample; and rows that are no rows.
`default_nettype none

module halfrow_core_bench;
    wire done_5, done_7;
    halfrow_core_check #(.TAPS(5)) five (.start(1'b1), .done(done_5));
    halfrow_core_check #(.TAPS(7)) seven (.start(done_5), .done(done_7));
    always @(posedge done_7) begin
        $display("DONE");
        $finish;
    end
endmodule

module halfrow_core_check #(parameter TAPS = 7) (input wire start, output reg done);
    localparam W = 64;
    localparam DELAY = W / 2 + ((TAPS == 7) ? 12 : 11);
    localparam LINEAR = 0, KEYS = 1, HERMITE = 2, WILD = 3;

    reg         clk, rst, enable, prepare, prepare_bank, in_valid, in_start, step_write, node_write, table_bank;
    reg         table_read;
    reg  [12:0] centre2;
    reg  [1:0]  depth;
    reg  [10:0] prepare_row, table_entry;
    reg  [11:0] in_sample;
    reg  [79:0] table_data;
    wire        prepared, out_valid, out_start, out_last, row_short, row_long, row_unprepared;
    wire [11:0] out_sample;
    wire [24:0] step_port;
    wire [79:0] node_port_0, node_port_1;

    halfrow_core #(.TAPS(TAPS)) core (
        .clk(clk), .rst(rst), .enable(enable), .width(12'd64), .last_row(11'd0), .centre2(centre2), .depth(depth),
        .prepare(prepare), .prepare_row(prepare_row), .prepare_bank(prepare_bank),
        .prepare_shape(4'd0), .prepared(prepared),
        .in_valid(in_valid), .in_start(in_start), .in_sample(in_sample),
        .out_valid(out_valid), .out_start(out_start), .out_last(out_last), .out_sample(out_sample),
        .row_short(row_short), .row_long(row_long), .row_unprepared(row_unprepared),
        .step_write(step_write), .node_write(node_write), .table_bank(table_bank), .table_entry(table_entry),
        .table_data(table_data), .table_read(table_read), .step_port(step_port), .node_port_0(node_port_0),
        .node_port_1(node_port_1));

    initial clk = 0;
    always #5 if (start && !done) clk = !clk;

    // What leaves, and when: the column of an output is the number of those since out_start.
    integer    pixel, entered_at [0:7], rows_in, rows_out, column, errors, shorts, longs, unprepareds;
    reg [31:0] crc [0:7];
    reg [31:0] reg_crc;

    function [31:0] crc_byte(input [31:0] before, input [7:0] data);
        integer b;
        begin
            crc_byte = before ^ {24'd0, data};
            for (b = 0; b < 8; b = b + 1)
                crc_byte = crc_byte[0] ? (crc_byte >> 1) ^ 32'hedb88320 : crc_byte >> 1;
        end
    endfunction

    always @(posedge clk) begin
        if (row_short) shorts = shorts + 1;
        if (row_long) longs = longs + 1;
        if (row_unprepared) unprepareds = unprepareds + 1;
        if (enable) begin
            if (out_valid) begin
                if (out_start) begin
                    column = 0;
                    reg_crc = 32'hffffffff;
                end
                if (out_start !== (column == 0) || out_last !== (column == W - 1)) errors = errors + 1;
                if (pixel !== entered_at[rows_out & 7] + column + DELAY) errors = errors + 1;
                reg_crc = crc_byte(crc_byte(reg_crc, out_sample[7:0]), {4'd0, out_sample[11:8]});
                column = column + 1;
                if (out_last) begin
                    crc[rows_out & 7] = ~reg_crc;
                    rows_out = rows_out + 1;
                end
            end
            pixel = pixel + 1;
        end
    end

    task clock; begin @(posedge clk); #1; prepare = 0; end endtask

    reg pauses;
    task pixel_clock;
        begin
            enable = 0;
            while (pauses && $random % 3 == 0) clock;
            enable = 1;
            clock;
            enable = 0;
        end
    endtask

    task reset;
        begin
            rst = 1; clock; rst = 0;
            pixel = 0; rows_in = 0; rows_out = 0; column = 0; errors = 0; shorts = 0; longs = 0; unprepareds = 0;
        end
    endtask

    task write_step(input bank, input [10:0] row, input [24:0] step);
        begin
            table_bank = bank; table_entry = row; table_data = step;
            step_write = 1; clock; step_write = 0;
        end
    endtask

    function [15:0] stored(input real weight);
        stored = $rtoi($floor(weight * 16384.0 + 0.5));
    endfunction

    function [15:0] wild(input integer node, input integer tap);
        reg [31:0] product;
        begin
            product = (5 * node + tap) * 32'd2654435761;
            wild = product[31:16] - 16'd32768;
        end
    endfunction

    task write_kernel(input bank, input integer kernel);
        integer node;
        real x;
        begin
            for (node = 0; node <= 64; node = node + 1) begin
                x = node / 32.0;
                case (kernel)
                    LINEAR: table_data = {16'd0, 16'd0, stored(x / 2), 16'd0, 16'd0};
                    KEYS: table_data = {stored(x*x*x/16 - x*x/8), 16'd0, stored(-3*x*x*x/16 + x*x/2 + x/4), 16'd0,
                                        stored(-x*x*x/16 + x*x/4 - x/4)};
                    HERMITE: table_data = {16'd0, stored(x*x*x/8 - x*x/4), stored(-x*x*x/4 + 3*x*x/4),
                                           stored(-x*x*x/8 + x*x/2 - x/2), 16'd0};
                    default: table_data = {wild(node, 4), wild(node, 3), wild(node, 2), wild(node, 1), wild(node, 0)};
                endcase
                table_bank = bank; table_entry = node;
                node_write = 1; clock; node_write = 0;
            end
        end
    endtask

    task prepare_next(input [10:0] row, input bank);
        begin
            prepare_row = row; prepare_bank = bank;
            prepare = 1; clock;
            await_prepared;
        end
    endtask

    task await_prepared;
        integer limit;
        begin
            for (limit = 0; !prepared && limit < 40; limit = limit + 1) clock;
            if (!prepared) errors = errors + 1;
        end
    endtask

    integer    next_at;   // the column with which the row behind is asked for; -1: none
    reg [10:0] next_row;
    reg        next_bank;

    // The first `samples` of row 0 of the golden frame, at the depth that is set.
    task enter(input integer samples);
        integer j;
        reg [31:0] product;
        begin
            entered_at[rows_in & 7] = pixel;
            rows_in = rows_in + 1;
            for (j = 0; j < samples; j = j + 1) begin
                product = j * 32'd2654435761;
                in_sample = product[31:20] >> (4 - 2 * depth);
                in_valid = 1; in_start = j == 0;
                if (j == next_at) {prepare, prepare_row, prepare_bank} = {1'b1, next_row, next_bank};
                pixel_clock;
            end
            in_valid = 0; in_start = 0; next_at = -1;
        end
    endtask

    // As enter; behind it the row of `next_row` is prepared, which is asked for with column `at`.
    task enter_asking(input integer at, input [10:0] row, input bank);
        begin
            next_at = at; next_row = row; next_bank = bank;
            enter(W);
            await_prepared;
        end
    endtask

    task blank(input integer clocks);
        integer k;
        for (k = 0; k < clocks; k = k + 1) pixel_clock;
    endtask

    task expect_row(input integer row, input [31:0] wanted);
        if (errors != 0 || rows_out <= row || crc[row & 7] !== wanted) begin
            $display("FAIL %0d taps, row %0d: CRC %h for %h, %0d rows out, %0d errors", TAPS, row, crc[row & 7], wanted,
                     rows_out, errors);
            done = 1;
        end
    endtask

    // One row of each of two generations, one behind the other, asked for with a column of the row in front, or behind it: 0.
    task pair(input integer blanking, input with_pauses, input integer asked);
        begin
            pauses = with_pauses;
            reset;
            prepare_next(11'd0, 1'b0);
            if (asked == 0) begin enter(W); prepare_next(11'd1, 1'b1); end
            else enter_asking(asked, 11'd1, 1'b1);
            blank(blanking);
            if (asked == 0) begin enter(W); prepare_next(11'd0, 1'b0); end
            else enter_asking(asked, 11'd0, 1'b0);
            blank(blanking); enter(W);
            blank(DELAY);
            expect_row(0, 32'h8b0d0aa8);
            expect_row(1, (TAPS == 7) ? 32'h1592d58e : 32'h0daa9274);
            expect_row(2, 32'h8b0d0aa8);
        end
    endtask

    task corner(input [1:0] at_depth, input [12:0] at_centre2, input [24:0] step, input integer kernel, input [31:0] wanted);
        begin
            reset;
            depth = at_depth; centre2 = at_centre2;
            write_step(1'b1, 11'd7, step); write_kernel(1'b1, kernel);
            prepare_next(11'd7, 1'b1); enter(W); blank(DELAY);
            expect_row(0, wanted);
        end
    endtask

    // A spoilt row is flagged, and the row behind it is exact.
    task spoilt(input integer samples, input integer blanking, input integer wanted_shorts, input integer wanted_longs);
        integer before;
        begin
            reset;
            prepare_next(11'd0, 1'b0);
            enter(W < samples ? W : samples);
            for (before = W; before < samples; before = before + 1) begin in_valid = 1; pixel_clock; end
            in_valid = 0;
            blank(blanking);
            prepare_next(11'd0, 1'b0); enter(W); blank(DELAY);
            if (shorts != wanted_shorts || longs != wanted_longs || unprepareds != 0 || crc[(rows_out - 1) & 7] !== 32'h8b0d0aa8) begin
                $display("FAIL %0d taps, %0d samples: %0d short, %0d long, %0d unprepared, CRC %h", TAPS, samples, shorts, longs,
                         unprepareds, crc[(rows_out - 1) & 7]);
                done = 1;
            end
        end
    endtask

    integer k;
    initial begin
        done = 0;
        {rst, enable, prepare, in_valid, in_start, step_write, node_write, table_read, pauses} = 0;
        in_sample = 0; next_at = -1; prepare_row = 0; prepare_bank = 0; table_entry = 0; table_bank = 0; table_data = 0;
        depth = 2; centre2 = 63;
        wait (start);
        rst = 1; clock; clock; reset;
        write_step(1'b0, 11'd0, 25'd14648488); write_kernel(1'b0, HERMITE);
        write_kernel(1'b1, (TAPS == 7) ? KEYS : LINEAR); write_step(1'b1, 11'd1, (TAPS == 7) ? 25'd14648488 : 25'd1);
        for (k = 0; k <= 8 && !done; k = k + 1) begin
            pair(k, 1'b0, 0); pair(k, 1'b1, 0);
            pair(k, k[0], 1); pair(k, !k[0], 1 + 7 * k);
        end
        if (!done) $display("PASS %0d taps: rows of two table banks, 0 to 8 clocks apart, %0d clocks behind", TAPS, DELAY);

        pauses = 0;
        for (k = 1; k < W && !done; k = k + 1) spoilt(k, 1 + k % 5, 1, 0);
        for (k = 1; k < 5 && !done; k = k + 1) spoilt(W + k, 1 + k % 5, 0, 1);
        if (!done) $display("PASS %0d taps: rows too short and too long are flagged, and the next is exact", TAPS);

        for (k = 1; k < 2 * W && !done; k = k + 9) begin
            reset; prepare_next(11'd0, 1'b0); enter(k < W ? k : W); if (k >= W) blank(k - W);
            reset;
            blank(2 * DELAY);
            if (rows_out != 0 || column != 0) begin $display("FAIL %0d taps: a row outlives a reset", TAPS); done = 1; end
            prepare_next(11'd0, 1'b0); enter(W); blank(DELAY); expect_row(0, 32'h8b0d0aa8);
        end
        reset; enter(W); blank(DELAY);
        if (unprepareds != 1) begin $display("FAIL %0d taps: an unprepared row is not flagged", TAPS); done = 1; end
        if (!done) $display("PASS %0d taps: resets in mid row, and a row that nobody prepared", TAPS);

        for (k = 0; k < 2; k = k + 1) begin
            pauses = k;
            if (!done) corner(2'd1, 13'd100, 25'd9000001, HERMITE, 32'h06f1c28b);
            if (!done) corner(2'd2, 13'd63, 25'd1, LINEAR, 32'h0daa9274);
            if (TAPS == 7) begin
                if (!done) corner(2'd2, 13'd0, 25'd1, KEYS, 32'h2ce17723);
                if (!done) corner(2'd2, 13'd126, 25'd16777215, KEYS, 32'he38d756b);
                if (!done) corner(2'd2, 13'd17, 25'd12345678, WILD, 32'hf84488c9);
                if (!done) corner(2'd0, 13'd63, 25'd8388608, WILD, 32'h741a394d);
                if (!done) corner(2'd2, 13'd126, 25'd8255472, WILD, 32'hdde42372);
            end
        end
        table_bank = 1; table_entry = 11'd40; table_read = 1; clock; clock;
        if (TAPS == 7 && (node_port_0 !== {wild(40, 4), wild(40, 3), wild(40, 2), wild(40, 1), wild(40, 0)} || node_port_1 !== node_port_0)) begin
            $display("FAIL %0d taps: node 40 reads back as %h and %h", TAPS, node_port_0, node_port_1); done = 1;
        end
        if (!done) $display("PASS %0d taps: the corners of the arithmetic, and the tables' ports", TAPS);
        done = 1;
    end
endmodule

`default_nettype wire
