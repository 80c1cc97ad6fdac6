// COMMITs of grids: how many entries a shape has in a frame, which shapes and sizes are refused, what the CRC covers, and which bank
// a shape belongs to; in a build of 2048 entries and two banks of tables and in one of 4096 and one bank.
`default_nettype none

module shapes_cases #(
    parameter ENTRY_BITS = 11,
    parameter TABLE_BANKS = 2
) (
    input  wire start,
    output reg  finished
);
    localparam MAX_WIDTH = 2592, MAX_HEIGHT = 1944, GRID = 1, TAPS = 7, LEAST_BLANKING = 0, ROW_BANKS_IN = 2, ROW_BANKS_OUT = 2;
    localparam GRIDS = 3, ENTRIES = 1 << ENTRY_BITS;
    `include "dispatcher_harness.vh"

    integer    w, h, v, k, size, drawn, legal_grids, first, last;
    reg  [7:0] next;
    wire       shadow = TABLE_BANKS == 2 && !active_bank;
    wire [3:0] shape = shapes >> 4 * (TABLE_BANKS == 2 && active_bank);

    function integer below(input integer limit);
        below = $unsigned($random(seed)) % limit;
    endfunction

    function integer size_of(input integer columns, input integer rows, input integer by_rows, input integer by_columns);
        size_of = ((columns + (1 << by_columns) - 1) / (1 << by_columns) + 2) * ((rows - 1) / (1 << by_rows) + 3);
    endfunction

    // With so many bytes of payload: 13 with v and k.
    task commit_shape(input integer entries, input [31:0] spoilt, input integer bytes);
        begin
            put32(0, table_crc(0, shadow, entries) ^ spoilt);
            put32(4, table_crc(1, shadow, 65));
            put16(8, 5);
            payload[10] = next;
            payload[11] = v;
            payload[12] = k;
            give(COMMIT, bytes, session);
        end
    endtask

    task taken(input [3:0] wanted);
        begin
            replied(COMMIT, 1);
            begin_frame(5);
            check(generation === next && shape === wanted, "the shape of the bank");
            next = next == 255 ? 1 : next + 1;
        end
    endtask

    task write_grid(input integer place, input integer count, input [31:0] value);
        integer n;
        begin
            put_span(0, 0, 0, place, count);
            payload[0] = GRIDS;
            for (n = 0; n < count; n = n + 1) put32(7 + 4 * n, value);
            give(TABLE_WRITE, 7 + 4 * count, session);
        end
    endtask

    task write_factors(input integer count);
        begin
            put_span(0, 0, 0, 3, count);
            put32(7, 32'h01000000);
            give(TABLE_WRITE, 7 + 4 * count, session);
            replied(TABLE_WRITE, 0);
        end
    endtask

    task one;
        begin
            w = 64 + 2 * below(below(2) ? 100 : 1265); h = 1 + below(below(2) ? 100 : 1944);
            v = 1 + below(6); k = 5 + below(2);
            size = size_of(w, h, v, k);
            configure(w, h, w - 1, 0, 0, 12);
            if (size > ENTRIES) begin
                commit_shape(1, 0, 13);
                refused(COMMIT, RANGE, 2);
            end else if (legal_grids < 5) begin
                legal_grids = legal_grids + 1;
                // The last entry counts, and the one behind it does not.
                write_grid(size - 1, 1, below(1 << 25));
                replied(TABLE_WRITE, 0);
                if (size < ENTRIES) write_grid(size, 1, below(1 << 25));
                commit_shape(size, 32'd1 << below(32), 13);
                refused(COMMIT, TABLE_CRC_WRONG, GRIDS);
                commit_shape(size, 0, 13);
                taken({k == 6, v[2:0]});
            end
        end
    endtask

    initial begin
        finished = 0;
        wait (start);
        start_up;
        while (!idle) @(negedge clk);
        hello(1, 2, 1, 1, 0);
        next = 1; legal_grids = 0;
        what = "entries of a grid";
        write_grid(ENTRIES - 1, 1, 32'h01ffffff); replied(TABLE_WRITE, 0);
        write_grid(ENTRIES - 1, 2, 1); refused(TABLE_WRITE, RANGE, ENTRIES - 1);
        write_grid(3, 2, 32'h02000000); refused(TABLE_WRITE, RANGE, 3);
        write_grid(3, 2, 0); replied(TABLE_WRITE, 0);
        check(steps[shadow*4096+3] === 25'd0 && steps[shadow*4096+ENTRIES-1] === 25'h1ffffff, "the entries written");
        passed;
        what = "shapes";
        v = 1; k = 5;
        commit_shape(1, 0, 13); refused(COMMIT, NOT_READY, 0);
        for (drawn = 0; drawn < 100; drawn = drawn + 1) one;
        check(legal_grids == 5, "too few grids fit");
        configure(128, 9, 127, 0, 0, 12);
        for (v = 7; v < 256; v = v + 83) begin
            commit_shape(1, 0, 13); refused(COMMIT, RANGE, 1);
        end
        for (k = 0; k < 256; k = k + (k < 16 ? 1 : 29)) begin
            v = 1 + k % 6;
            if (k != 5 && k != 6) begin commit_shape(1, 0, 13); refused(COMMIT, RANGE, 2); end
        end
        passed;
        what = "commits without a grid";
        v = 0; k = 77; commit_shape(9, 0, 13); taken(4'd0);
        v = 3; k = 5; commit_shape(size_of(128, 9, 3, 5), 0, 13); taken(4'd3);
        commit_shape(9, 0, 12); taken(4'd0);
        commit_shape(size_of(128, 9, 3, 5), 0, 13); taken(4'd3);
        commit_shape(9, 0, 11); taken(4'd0);
        commit_shape(size_of(128, 9, 3, 5), 0, 300); taken(4'd3);
        passed;
        what = "row factors over a grid";
        repeat (2) begin commit_shape(size_of(128, 9, 3, 5), 0, 13); taken(4'd3); end
        write_grid(3, 1, 32'h01ffffff); replied(TABLE_WRITE, 0);
        write_factors(0);
        check(shapes === (TABLE_BANKS == 2 ? 8'h33 : 8'h03), "what writes no factor leaves the shape");
        write_factors(1);
        check(shapes === (TABLE_BANKS == 1 ? 8'h00 : shadow ? 8'h03 : 8'h30), "a bank with row factors has no shape");
        payload[0] = 2; put32(1, 99); give(RESET, 5, session); replied(RESET, 0);
        check(shapes === 8'd0, "a wiped bank has no shape");
        passed;
        finished = 1;
    end
endmodule

module halfrow_shapes_bench;
    wire two_finished, one_finished;

    shapes_cases two_banks (.start(1'b1), .finished(two_finished));
    shapes_cases #(.ENTRY_BITS(12), .TABLE_BANKS(1)) one_bank (.start(two_finished), .finished(one_finished));

    always @(posedge one_finished) begin
        $display("DONE");
        $finish;
    end
endmodule

`default_nettype wire
