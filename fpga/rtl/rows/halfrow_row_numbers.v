// The row sequence numbers that credit, order and acknowledgement are counted by. One number is kept whole, that of the
// first row that is not acknowledged; the others are counted from it, and the 32-bit ones show up to 20 clocks late.
`default_nettype none

module halfrow_row_numbers #(
    parameter IN_BITS = 1,
    parameter ENTRY_BITS = 2 // more than either kind of bank needs
) (
    input  wire                    clk,
    input  wire                    rst,

    input  wire                    drop,
    input  wire [31:0]             drop_next_row,
    input  wire                    acknowledge,
    input  wire [31:0]             acknowledge_window,
    output wire                    settling,     // an acknowledgement is being looked at

    input  wire                    arrived,      // a row is whole in its in-bank
    input  wire [IN_BITS-1:0]      arrived_bank,
    input  wire                    entered,      // the next row has entered the core with all its samples
    input  wire                    left,         // the oldest row inside has left it
    input  wire                    sent,         // the first row that was never sent has been

    output reg  [31:0]             acknowledged, // the first row that is not acknowledged
    output reg  [31:0]             credit_window,
    output reg  [31:0]             next_row_in,
    output reg  [ENTRY_BITS-1:0]   rows_entered, // rows from `acknowledged` on that have entered
    output reg  [ENTRY_BITS-1:0]   rows_left,    // of them, rows that have left the core
    output reg  [ENTRY_BITS-1:0]   rows_sent,    // of them, rows that have been sent
    // low bits of the first row that has not entered, has not left, was never sent
    output reg  [ENTRY_BITS-1:0]   next_entry,
    output reg  [ENTRY_BITS-1:0]   leaving_entry,
    output reg  [ENTRY_BITS-1:0]   unsent_entry,
    output reg  [(1<<IN_BITS)-1:0] waiting,      // in-banks that hold a row, until it has entered
    output reg                     played        // a row has entered since rows were dropped
);
    localparam LOAD = 3'd0, COMPARE = 3'd1, RELEASE = 3'd2, CREDIT = 3'd3, NEXT = 3'd4;
    localparam ROW_BANKS_IN = 1 << IN_BITS;
    localparam [7:0] BANKS_IN = ROW_BANKS_IN;
    localparam [2:0] PREPARE = 3'd7;

    // One adder goes round: bytes 0 to 3 of one number in four clocks, and a clock to choose the next.
    reg [2:0] operation, place;
    reg [7:0] addend; // to byte 0, so 0 at the others
    reg carry;
    reg [23:0] lower;
    reg load_waits, compare_waits, release_waits, credit_was_last;
    reg [31:0] window;
    wire [ENTRY_BITS-1:0] release_rows;
    wire [ENTRY_BITS:0] known; // rows from `acknowledged` on without one missing

    reg [7:0] acknowledged_byte, drop_byte, window_byte;
    wire [1:0] next_byte = place[1:0] + 2'd1;
    wire [7:0] number = operation == LOAD ? drop_byte : acknowledged_byte;
    wire [9:0] sum = {1'b0, number, 1'b1} + {1'b0, addend, carry};
    wire [31:0] result = {sum[8:1], lower};
    reg complete; // with the last byte
    wire releases = complete && operation == RELEASE;

    assign settling = acknowledge || load_waits || compare_waits || release_waits;

    reg [2:0] next_operation;
    reg [7:0] next_addend;
    reg [ENTRY_BITS-1:0] to_release;

    always @* begin
        next_operation = CREDIT;
        next_addend = {{8-ENTRY_BITS{1'b0}}, rows_entered} + BANKS_IN;
        if (load_waits) begin
            next_operation = LOAD;
            next_addend = 8'd0;
        end else if (compare_waits)
            next_operation = COMPARE;
        else if (release_waits) begin
            next_operation = RELEASE;
            next_addend = {{8-ENTRY_BITS{1'b0}}, release_rows};
        end else if (credit_was_last) begin
            next_operation = NEXT;
            next_addend = {{7-ENTRY_BITS{1'b0}}, known};
        end
    end

    always @(posedge clk) begin
        carry <= place != PREPARE && sum[9];
        lower <= {sum[8:1], lower[23:8]};
        acknowledged_byte <= acknowledged[{next_byte, 3'd0} +: 8];
        drop_byte <= drop_next_row[{next_byte, 3'd0} +: 8];
        window_byte <= window[{next_byte, 3'd0} +: 8];
        place <= complete ? PREPARE : place + 3'd1;
        complete <= place == 3'd2;
        addend <= 8'd0;
        if (place == PREPARE) begin
            operation <= next_operation;
            addend <= next_addend;
            to_release <= next_addend[ENTRY_BITS-1:0];
        end
        if (complete) begin
            if (operation == LOAD)
                load_waits <= 1'b0;
            if (operation == COMPARE) begin
                compare_waits <= 1'b0;
                release_waits <= 1'b1;
            end
            if (operation == RELEASE)
                release_waits <= 1'b0;
            credit_was_last <= operation == CREDIT;
        end
        if (acknowledge) begin
            compare_waits <= 1'b1;
            window <= acknowledge_window;
        end
        if (rst || drop) begin
            place <= PREPARE;
            complete <= 1'b0;
            operation <= NEXT;
            load_waits <= drop && !rst;
            compare_waits <= 1'b0;
            release_waits <= 1'b0;
            credit_was_last <= 1'b0;
        end
    end

    // The window never wraps, so the last number of all gets no credit.
    always @(posedge clk) begin
        if (rst)
            acknowledged <= 32'd0;
        else if (complete && (operation == LOAD || operation == RELEASE))
            acknowledged <= result;
        if (complete && operation == CREDIT && sum[9])
            credit_window <= 32'hffffffff;
        else if (complete && operation == CREDIT)
            credit_window <= result;
        if (complete && operation == NEXT)
            next_row_in <= result;
    end

    // A host cannot have a row that was never sent, so a window beyond those that were counts as far as they go.
    reg behind, far;
    reg [ENTRY_BITS-1:0] near;
    wire [9:0] ahead = {1'b0, window_byte, 1'b0} - {1'b0, acknowledged_byte, behind};

    always @(posedge clk)
        if (operation == COMPARE && place != PREPARE) begin
            behind <= ahead[9];
            if (place == 3'd0) begin
                near <= ahead[ENTRY_BITS:1];
                far <= ahead[8:ENTRY_BITS+1] != {8-ENTRY_BITS{1'b0}};
            end else
                far <= far || ahead[8:1] != 8'd0;
        end else if (operation != COMPARE)
            behind <= 1'b0;

    assign release_rows = behind ? {ENTRY_BITS{1'b0}} : far || near > rows_sent ? rows_sent : near;

    wire unused = &{1'b0, sum[0], ahead[0]};
    wire [ENTRY_BITS-1:0] released = to_release & {ENTRY_BITS{releases}};

    always @(posedge clk)
        if (rst || drop) begin
            rows_entered <= {ENTRY_BITS{1'b0}};
            rows_left <= {ENTRY_BITS{1'b0}};
            rows_sent <= {ENTRY_BITS{1'b0}};
        end else begin
            rows_entered <= rows_entered + {{ENTRY_BITS-1{1'b0}}, entered} - released;
            rows_left <= rows_left + {{ENTRY_BITS-1{1'b0}}, left} - released;
            rows_sent <= rows_sent + {{ENTRY_BITS-1{1'b0}}, sent} - released;
        end

    always @(posedge clk)
        if (rst) begin
            next_entry <= {ENTRY_BITS{1'b0}};
            leaving_entry <= {ENTRY_BITS{1'b0}};
            unsent_entry <= {ENTRY_BITS{1'b0}};
        end else if (complete && operation == LOAD) begin
            next_entry <= lower[ENTRY_BITS-1:0];
            leaving_entry <= lower[ENTRY_BITS-1:0];
            unsent_entry <= lower[ENTRY_BITS-1:0];
        end else begin
            next_entry <= next_entry + {{ENTRY_BITS-1{1'b0}}, entered};
            leaving_entry <= leaving_entry + {{ENTRY_BITS-1{1'b0}}, left};
            unsent_entry <= unsent_entry + {{ENTRY_BITS-1{1'b0}}, sent};
        end

    always @(posedge clk)
        if (rst || drop) begin
            waiting <= {ROW_BANKS_IN{1'b0}};
            played <= 1'b0;
        end else begin
            if (arrived)
                waiting[arrived_bank] <= 1'b1;
            if (entered) begin
                waiting[next_entry[IN_BITS-1:0]] <= 1'b0;
                played <= 1'b1;
            end
        end

    // Rows that wait without one missing between them, from the next one on.
    reg [ENTRY_BITS-1:0] in_line;
    reg unbroken;
    reg [IN_BITS-1:0] bank;
    integer k;

    always @* begin
        in_line = {ENTRY_BITS{1'b0}};
        unbroken = 1'b1;
        bank = next_entry[IN_BITS-1:0];
        for (k = 0; k < ROW_BANKS_IN; k = k + 1) begin
            unbroken = unbroken && waiting[bank];
            in_line = in_line + {{ENTRY_BITS-1{1'b0}}, unbroken};
            bank = bank + 1'b1;
        end
    end

    assign known = {1'b0, rows_entered} + {1'b0, in_line};
endmodule

`default_nettype wire
