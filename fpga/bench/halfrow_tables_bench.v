// The requests that the tables have a part in, on a large build with seven taps and two banks and on a small one with five taps
// and one bank. Every request is drawn, told what to expect by a plain model of the tables, and compared.
`default_nettype none

module tables_cases #(
    parameter MAX_HEIGHT = 2048,
    parameter GRID = 0,
    parameter ENTRY_BITS = 11,
    parameter TAPS = 7,
    parameter TABLE_BANKS = 2
) (
    output reg finished
);
    localparam MAX_WIDTH = 2048, LEAST_BLANKING = 0, ROW_BANKS_IN = 2, ROW_BANKS_OUT = 2;
    `include "dispatcher_harness.vh"

    localparam SEVEN = TAPS == 7;

    // What the banks should hold, and what rows should use.
    reg [24:0] model_steps [0:8191];
    reg [79:0] model_nodes [0:255];
    reg        model_active, model_pending;
    reg [ 7:0] model_generation, model_next;
    reg [15:0] model_frame;
    integer    drawn, k, m, value, length, most, stalls;
    reg        of_kernel, bad, good;
    reg [79:0] entry;

    wire shadow = TABLE_BANKS == 2 && !model_active;

    function integer below(input integer limit);
        below = $unsigned($random(seed)) % limit;
    endfunction

    function integer entries(input kernel);
        entries = kernel ? 65 : MAX_HEIGHT;
    endfunction

    // A legal step, now and then the least or the greatest.
    function [31:0] a_step(input integer unused);
        case (below(8))
            0:       a_step = 1;
            1:       a_step = 1 << 24;
            2:       a_step = 1 << below(25);
            default: a_step = 1 + below(1 << 24);
        endcase
    endfunction

    function [79:0] a_node(input integer unused);
        begin
            a_node = {$random(seed), $random(seed), $random(seed)};
            if (!SEVEN) {a_node[79:64], a_node[15:0]} = 32'd0;
        end
    endfunction

    task put_entry(input kernel, input integer number, input [79:0] contents);
        integer b;
        for (b = 0; b < (kernel ? 10 : 4); b = b + 1) payload[7+number*(kernel ? 10 : 4)+b] = contents >> 8 * b;
    endtask

    // Everything that the core holds is what the model holds.
    task same_tables;
        begin
            good = 1;
            for (m = 0; m < TABLE_BANKS * 4096; m = m + 1)
                if ((m & 4095) < MAX_HEIGHT && steps[m] !== model_steps[m]) good = 0;
            for (m = 0; m < TABLE_BANKS * 128; m = m + 1)
                if ((m & 127) < 65 && (nodes_0[m] !== model_nodes[m] || nodes_1[m] !== model_nodes[m])) good = 0;
            check(good, "the tables differ");
            check(generation === model_generation && active_bank === model_active && commit_pending === model_pending, "generations");
        end
    endtask

    task wiped;
        begin
            for (m = 0; m < 8192; m = m + 1) model_steps[m] = 1 << 24;
            for (m = 0; m < 256; m = m + 1) model_nodes[m] = 0;
            {model_active, model_pending, model_generation} = 0;
            same_tables;
        end
    endtask

    task write(input kernel, input integer bank, input integer first, input integer count, input integer wrong);
        begin
            put_span(kernel, bank, below(256), first, count);
            for (k = 0; k < count && k < 1018; k = k + 1) begin
                entry = kernel ? a_node(0) : a_step(0);
                if (k == wrong)
                    entry = kernel ? {entry[79:1], 1'b1} : below(2) ? 0 : (1 << 24) + (1 + below(1 << 24)) * (1 + below(100));
                put_entry(kernel, k, entry);
            end
            bad    = wrong >= 0 && wrong < count && !(kernel && SEVEN);
            value  = writes;
            length = 7 + count * (kernel ? 10 : 4);
            give(TABLE_WRITE, length, session);
            if (bank != 0) refused(TABLE_WRITE, RANGE, first);
            else if (shadow_in_use || model_pending) refused(TABLE_WRITE, BUSY, 0);
            else if (first + count > entries(kernel)) refused(TABLE_WRITE, RANGE, first);
            else if (bad) refused(TABLE_WRITE, kernel ? OUTER_TAPS : RANGE, first + wrong);
            else begin
                replied(TABLE_WRITE, 0);
                value = value + count;
                for (k = 0; k < count; k = k + 1) begin
                    for (m = 0; m < 10; m = m + 1) entry = {payload[7+k*(kernel ? 10 : 4)+(m % (kernel ? 10 : 4))], entry[79:8]};
                    if (kernel) model_nodes[shadow*128+first+k] = entry;
                    else model_steps[shadow*4096+first+k] = entry[24:0];
                end
            end
            check(writes == value, "entries written");
        end
    endtask

    function [7:0] table_byte(input kernel, input bank, input integer number);
        table_byte = kernel ? model_nodes[bank*128+number/10] >> 8 * (number % 10)
                            : {7'd0, model_steps[bank*4096+number/4]} >> 8 * (number % 4);
    endfunction

    task read(input [7:0] kind, input kernel, input integer bank, input integer port, input integer first, input integer count);
        reg     physical;
        integer size, b;
        begin
            put_span(kernel, bank, port, first, count);
            size     = kernel ? 10 : 4;
            physical = bank ? model_active : shadow;
            give(kind, 7, session);
            if (core_busy) refused(kind, BUSY, 0);
            else if (port > kernel || first + count > entries(kernel) || (kind == TABLE_READ && 7 + count * size > 4080))
                refused(kind, RANGE, first);
            else if (kind == TABLE_READ) begin
                replied(TABLE_READ, 7 + count * size);
                for (b = 0; b < 7; b = b + 1) check(got[b] === payload[b], "the span");
                good = 1;
                for (b = 0; b < count * size; b = b + 1)
                    if (got[7+b] !== table_byte(kernel, physical, first * size + b)) good = 0;
                check(good, "the entries");
            end else begin
                replied(TABLE_CRC, 4);
                value = 32'hffffffff;
                for (b = 0; b < count * size; b = b + 1) value = crc_step(value, table_byte(kernel, physical, first * size + b));
                check({got[3], got[2], got[1], got[0]} === ~value, "the CRC");
            end
        end
    endtask

    task draw_span(output integer first, output integer count, input kernel);
        case (below(6))
            0: begin
                first = entries(kernel);
                count = below(2);
            end
            1: begin
                first = below(65536);
                count = below(4);
            end
            2: begin
                count = below(5);
                first = entries(kernel) - count + below(2);
            end
            default: begin
                count = below(kernel ? 66 : 20);
                first = below(entries(kernel));
            end
        endcase
    endtask

    task request;
        integer first, count;
        begin
            {core_busy, shadow_in_use} = below(10) ? 0 : 1 + below(3);
            of_kernel = below(2);
            draw_span(first, count, of_kernel);
            case (below(4))
                0, 1:    write(of_kernel, below(12) == 0, first, count, below(3) ? -1 : below(count + 1));
                2:       read(TABLE_READ, of_kernel, below(2), below(8) ? below(of_kernel + 1) : below(256), first, count);
                default: read(TABLE_CRC, of_kernel, below(2), below(8) ? below(of_kernel + 1) : below(256), first, count);
            endcase
            {core_busy, shadow_in_use} = 0;
        end
    endtask

    task commits(input integer h);
        reg [7:0] next;
        begin
            configure(64, h, 63, 0, 0, 12);
            check(height == h, "configured");
            next = model_generation + 1 + below(200);
            if (next == 0) next = 1;
            core_busy = 1;
            commit(1, 1, 3, next);
            refused(COMMIT, BUSY, 0);
            core_busy = 0;
            commit(1, 1, 3, 0);
            refused(COMMIT, RANGE, 0);
            commit(~table_crc(0, shadow, h), table_crc(1, shadow, 65), 3, next);
            refused(COMMIT, TABLE_CRC_WRONG, 0);
            commit(table_crc(0, shadow, h), table_crc(1, shadow, 65) ^ (1 << below(32)), 3, next);
            refused(COMMIT, TABLE_CRC_WRONG, 1);
            // One port alone reads another node.
            m          = shadow * 128 + below(65);
            entry      = nodes_1[m];
            nodes_1[m] = entry ^ 80'd1 << (SEVEN ? below(80) : 16 + below(48));
            commit_shadow(3, next);
            refused(COMMIT, TABLE_CRC_WRONG, 1);
            nodes_1[m] = entry;
            same_tables;
            commit_shadow(17, next);
            replied(COMMIT, 1);
            check(got[0] === next, "the reply's generation");
            if (TABLE_BANKS == 1) model_generation = next;
            else model_pending = 1;
            same_tables;
            core_busy = 1;
            commit(5, 6, 3, next);
            replied(COMMIT, 1);
            core_busy = 0;
            if (TABLE_BANKS == 2) begin
                commit_shadow(17, next == 255 ? 1 : next + 1);
                refused(COMMIT, BUSY, 0);
                write(0, 0, 0, 1, -1);
                read(TABLE_CRC, 1, 0, 1, 0, 65);
                begin_frame(16);
                same_tables;
                if (h & 1) begin
                    begin_frame(17);
                    {model_active, model_pending} = {!model_active, 1'b0};
                    model_generation              = next;
                end else begin
                    payload[0] = h & 2;
                    put32(1, 99);
                    give(RESET, 5, session);
                    replied(RESET, 0);
                    model_pending = 0;
                    if (payload[0] == 2) wiped;
                end
                same_tables;
                begin_frame(17);
                same_tables;
            end
        end
    endtask

    initial begin
        finished = 0;
        // Stalls of the large build take half a minute.
        stalls   = MAX_HEIGHT < 1018 || $test$plusargs("all") ? 3 : 1;
        start_up;
        while (!idle) @(negedge clk);
        what = "wiping";
        wiped;
        hello(1, 2, 1, 1, 0);
        commit(0, 0, 0, 1);
        refused(COMMIT, NOT_READY, 0);
        passed;
        for (stall = 0; stall < stalls; stall = stall + 1) begin
            what = "writes and reads";
            for (drawn = 0; drawn < 50; drawn = drawn + 1) begin
                request;
                if (drawn % 25 == 0) same_tables;
            end
            if (stall == stalls - 1) passed;
            what = "the longest spans";
            most = MAX_HEIGHT < 1018 ? MAX_HEIGHT : 1018;
            if (stall == 0) write(0, 0, MAX_HEIGHT - most, most, -1);
            if (stall == 0) write(0, 0, 0, most, most - 1);
            write(1, 0, 0, 65, -1);
            write(1, 0, 0, 66, -1);
            read(TABLE_READ, 0, 0, 0, MAX_HEIGHT - most, most);
            read(TABLE_READ, 0, 0, 0, 0, 1019);
            read(TABLE_READ, 1, 0, 1, 0, 65);
            if (stall == 0) read(TABLE_CRC, 0, 0, 0, 0, MAX_HEIGHT);
            read(TABLE_CRC, 0, 0, 0, 0, 65535);
            read(TABLE_READ, 1, 0, 1, 0, 65535);
            read(TABLE_CRC, 1, 0, 1, 65535, 65535);
            same_tables;
            if (stall == stalls - 1) passed;
            what = "commits";
            for (drawn = 2 * stall + 1; drawn < 2 * stall + 3; drawn = drawn + 1) begin
                write(1, 0, 0, 65, -1);
                write(0, 0, 0, 20, -1);
                commits(drawn);
            end
            if (stall == 1) commits(MAX_HEIGHT);
            if (stall == stalls - 1) passed;
            what = "payloads";
            for (k = 0; k < 40; k = k + 1) begin
                of_kernel = k & 1;
                put_span(of_kernel, 0, 0, 0, k < 20 ? 1 + below(30) : 1024 + below(64000));
                length = 7 + (k < 20 ? payload[5] * (of_kernel ? 10 : 4) : below(4074));
                give(TABLE_WRITE, length - (k < 20), session);
                refused(TABLE_WRITE, PAYLOAD, 0);
                put_span(of_kernel, 0, 0, 0, 0);
                payload[k&4?0 : 1] = 2 + below(254);
                give(k & 8 ? TABLE_READ : k & 16 ? TABLE_CRC : TABLE_WRITE, 7, session);
                check(got_kind == 8'h7f && got[0] === PAYLOAD, "a table or bank without meaning");
            end
            same_tables;
            if (stall == stalls - 1) passed;
        end
        finished = 1;
    end
endmodule

module halfrow_tables_bench;
    wire large_finished, small_finished;

    tables_cases of_large (.finished(large_finished));
    tables_cases #(.MAX_HEIGHT(100), .ENTRY_BITS(7), .TAPS(5), .TABLE_BANKS(1)) of_small (.finished(small_finished));

    always @(large_finished or small_finished)
        if (large_finished && small_finished) begin
            $display("DONE");
            $finish;
        end
endmodule

`default_nettype wire
