// The row sequence numbers that credit, order and acknowledgement are counted by. One number is kept whole, that of the
// first row that is not acknowledged; the others are counted from it.
`default_nettype none

module halfrow_row_numbers #(
    parameter ROW_BANKS_IN = 2,
    parameter IN_BITS = 1,
    parameter ENTRY_BITS = 2                       // more than either kind of bank needs
) (
    input  wire                    clk,
    input  wire                    rst,

    input  wire                    drop,
    input  wire [31:0]             drop_next_row,
    input  wire                    acknowledge,
    input  wire [31:0]             acknowledge_window,
    output wire                    settling,       // an acknowledgement is being looked at

    input  wire                    arrived,        // a row is whole in its in-bank
    input  wire [IN_BITS-1:0]      arrived_bank,
    input  wire                    entered,        // the next row has entered the core with all its samples
    input  wire                    left,           // the oldest row inside has left it
    input  wire                    sent,           // the first row that was never sent has been

    output reg  [31:0]             acknowledged,   // the first row that is not acknowledged
    output reg  [31:0]             credit_window,
    output reg  [31:0]             next_row_in,    // one clock late
    output reg  [ENTRY_BITS-1:0]   rows_entered,   // rows from `acknowledged` on that have entered
    output reg  [ENTRY_BITS-1:0]   rows_left,      // of them, rows that have left the core
    output reg  [ENTRY_BITS-1:0]   rows_sent,      // of them, rows that have been sent
    output wire [ENTRY_BITS-1:0]   next_entry,     // low bits of the first row that has not entered
    output reg  [ROW_BANKS_IN-1:0] waiting,        // in-banks that hold a row, until it has entered
    output reg                     played          // a row has entered since rows were dropped
);
    localparam [31:0] BANKS_IN = ROW_BANKS_IN;

    // A host cannot have a row that was never sent, so a window beyond those that were counts as far as they go.
    reg                   comparing, releasing;
    reg  [32:0]           ahead;
    reg  [ENTRY_BITS-1:0] release_rows;
    wire                  far = ahead[31:ENTRY_BITS] != {32-ENTRY_BITS{1'b0}};
    wire [ENTRY_BITS-1:0] near = ahead[ENTRY_BITS-1:0];
    wire [ENTRY_BITS-1:0] released = release_rows & {ENTRY_BITS{releasing}};

    assign settling = acknowledge || comparing || releasing;

    always @(posedge clk) begin
        comparing <= acknowledge && !drop && !rst;
        releasing <= comparing && !drop && !rst;
        ahead <= {1'b0, acknowledge_window} - {1'b0, acknowledged};
        release_rows <= ahead[32] ? {ENTRY_BITS{1'b0}} : far || near > rows_sent ? rows_sent : near;
    end

    always @(posedge clk)
        if (rst)
            acknowledged <= 32'd0;
        else if (drop)
            acknowledged <= drop_next_row;
        else
            acknowledged <= acknowledged + {{32-ENTRY_BITS{1'b0}}, released};

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

    // The window never wraps, so the last number of all gets no credit.
    wire [31:0] credit_from = rst ? 32'd0 : drop ? drop_next_row : credit_window;
    wire [32:0] credit = {1'b0, credit_from} + {1'b0, rst || drop ? BANKS_IN : {31'd0, entered}};

    always @(posedge clk)
        if (credit[32])
            credit_window <= 32'hffffffff;
        else
            credit_window <= credit[31:0];

    assign next_entry = acknowledged[ENTRY_BITS-1:0] + rows_entered;

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
    reg  [ENTRY_BITS-1:0] in_line;
    reg                   unbroken;
    reg  [IN_BITS-1:0]    bank;
    integer               k;

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

    wire [ENTRY_BITS:0] known = {1'b0, rows_entered} + {1'b0, in_line};

    always @(posedge clk)
        next_row_in <= acknowledged + {{31-ENTRY_BITS{1'b0}}, known};
endmodule

`default_nettype wire
