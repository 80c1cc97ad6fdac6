// The host of halfrow_rows_bench.v: gives rows, waits for what is due, acknowledges, drops and configures.

reg [31:0] base = 0;                          // number of the first row of frame 0
reg [3:0]  refusal;
integer    waited;

task put(input [31:0] row_number, input [15:0] frame, input [15:0] row, input [15:0] row_width, input last);
    integer j;
    begin
        {packet[3], packet[2], packet[1], packet[0]} = row_number;
        {packet[5], packet[4]} = frame;
        {packet[7], packet[6]} = row;
        {packet[9], packet[8]} = row_width;
        {packet[11], packet[10]} = {8'd0, 7'h55, last};
        for (j = 0; j < row_width && j < 2700; j = j + 2)
            {packet[14 + j / 2 * 3], packet[13 + j / 2 * 3], packet[12 + j / 2 * 3]} =
                {sample_of(row_number, j + 1), sample_of(row_number, j)};
        packet_length = 12 + row_width / 2 * 3;
    end
endtask

task pulse_acknowledge;
    begin
        @(negedge clk) acknowledge = 1;
        @(negedge clk) acknowledge = 0;
        repeat (16) @(negedge clk);           // the next packet takes longer to come
    end
endtask

task deliver;
    begin
        @(negedge clk) acknowledge = 1;
        @(negedge clk) {acknowledge, row_start} = 2'b01;
        @(negedge clk) row_start = 0;
        waited = 0;
        while (!row_done && waited < 100000) begin
            @(negedge clk);
            waited = waited + 1;
        end
        if (!row_done)
            expect_equal("row_done", 0, 1);
        refusal = row_refusal;
        @(negedge clk);
    end
endtask

task refused(input [31:0] code);
    begin
        deliver;
        expect_equal("refusal", refusal, code);
    end
endtask

task place(input [31:0] row_number);
    reg [31:0] row;
    begin
        row = row_number - base;
        put(row_number, row / height, row % height, width, row % height == height - 1);
    end
endtask

// What must come back of a row.
task due(input [31:0] row_number, input [15:0] frame, input [15:0] row, input [7:0] of_generation);
    begin
        frame_of[row_number[3:0]] = frame;
        row_of[row_number[3:0]] = row;
        generation_of[row_number[3:0]] = of_generation;
        width_of[row_number[3:0]] = width;
        last_of[row_number[3:0]] = row == height - 1;
        pauses_of[row_number[3:0]] = pauses[row];
        repeats_of[row_number[3:0]] = 0;
    end
endtask

// The row as it belongs there, which the board has not got.
task send(input [31:0] row_number);
    reg [31:0] row;
    begin
        row = row_number - base;
        place(row_number);
        due(row_number, row / height, row % height,
            commit_pending && row / height >= commit_frame ? commit_generation : generation);
        refused(0);
    end
endtask

task settle;
    begin
        repeat (4) @(negedge clk);
        waited = 0;
        while ((!quiet || at >= 0) && waited < 400000) begin
            @(negedge clk);
            waited = waited + 1;
        end
        if (!quiet)
            expect_equal("quiet", 0, 1);
        repeat (20) @(negedge clk);           // numbers may show so late
    end
endtask

task acknowledge_all;
    begin
        window = next_new;
        pulse_acknowledge;
        settle;
    end
endtask

task drop(input [31:0] next, input other_session);
    begin
        @(negedge clk) drop_rows = 1;
        drop_next_row = next;
        new_session = other_session;
        @(negedge clk) drop_rows = 0;
        if (other_session)
            session = session + 1;
        base = next;
        next_new = next;
        window = next;
        repeat (16) @(negedge clk);           // the reply is not made before
    end
endtask

task configure(input [11:0] w, input [11:0] h, input [15:0] b, input [31:0] seed);
    reg [31:0] x;
    integer r, c;
    begin
        width = w;
        height = h;
        blanking = b;
        gap_seed = seed;
        x = seed;
        for (r = 0; r < h; r = r + 1) begin
            pauses[r] = 0;
            extra[r] = 0;
            for (c = r == 0 ? 0 : -1; c < $signed({20'd0, w}) && seed != 0; c = c + 1) begin
                x = x ^ x << 13;
                x = x ^ x >> 17;
                x = x ^ x << 5;
                if (c < 0)
                    extra[r] = x[3:0];
                else if (x[2:0] == 0)
                    pauses[r] = pauses[r] + 1;
            end
        end
    end
endtask

// Plays frames as fast as credit allows, and looks at the pixel clocks in front of each row.
reg [31:0] next_row;
reg [15:0] started;

task play(input integer frames);
    begin
        base = next_new;
        next_row = next_new;
        started = core.rows;
        waited = 0;
        while (next_new != base + frames * height && waited < 400000) begin
            window = next_new;
            if (next_row != base + frames * height && next_row < credit_window) begin
                send(next_row);
                next_row = next_row + 1;
            end else begin
                repeat ($random & 63) @(negedge clk);
                pulse_acknowledge;
                waited = waited + 1;
            end
        end
        expect_equal("rows that came back", next_new - base, frames * height);
        acknowledge_all;
        expect_equal("rows left behind", {rows_waiting, rows_held, core_busy}, 0);
        expect_equal("rows that started", core.rows - started, frames * height);
        while (started != core.rows) begin
            if (core.row_of[started[11:0]] != 0)
                expect_equal("blanking", core.blank_before[started[11:0]], blanking + extra[core.row_of[started[11:0]]]);
            started = started + 1;
        end
    end
endtask
