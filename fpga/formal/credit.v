// halfrow_row_numbers under any entries, results, acknowledgements and drops that the row path can make: the window never
// promises a bank that there is not, it comes to all banks there are, and no count loses a row.
`default_nettype none

module credit #(
    parameter IN_BITS = 1,
    parameter SOON = 24,                     // clocks in which the window follows what has happened
    parameter DROPS = 1,                     // 0: none, and rows move from the reset on, which leaves more clocks to them
    parameter APART = 8                      // clocks between two rows' last samples, at least; W is 64 or more
) (
    input wire        clk,
    input wire        drop,
    input wire [4:0]  drop_number,           // the rows' numbers lie near 0 or near the last of all
    input wire        acknowledge,
    input wire [4:0]  acknowledge_number,
    input wire        wants_entry,
    input wire        wants_exit,
    input wire        wants_sending
);
    localparam BANKS = 1 << IN_BITS;
    localparam ENTRY_BITS = IN_BITS + 1;
    localparam SETTLED = DROPS ? SOON : 0;
    localparam [31:0] MOST = 32'hffffffff;

    wire [31:0] drop_next_row = {{28{drop_number[4]}}, drop_number[3:0]};
    wire [31:0] acknowledge_window = {{28{acknowledge_number[4]}}, acknowledge_number[3:0]};

    reg running = 1'b0;
    always @(posedge clk) running <= 1'b1;
    wire clear = !running || drop;

    wire [31:0] acknowledged, credit_window, next_row_in;
    wire [ENTRY_BITS-1:0] rows_entered, rows_left, rows_sent, next_entry;
    wire [BANKS-1:0] waiting;
    wire settling, played;

    // The row numbers, whole, since the last drop. An out-bank is free again when its row is acknowledged.
    reg  [31:0] first, entered, left, sent;
    reg  [5:0]  since_entry, since_drop, since_change;
    wire        enters = wants_entry && since_entry >= APART && since_drop >= SETTLED && rows_entered < BANKS && entered != MOST;
    wire        leaves = wants_exit && left != entered;
    wire        sends = wants_sending && sent != left;

    halfrow_row_numbers #(.IN_BITS(IN_BITS), .ENTRY_BITS(ENTRY_BITS)) numbers (
        .clk(clk), .rst(!running), .drop(drop), .drop_next_row(drop_next_row),
        .acknowledge(acknowledge), .acknowledge_window(acknowledge_window), .settling(settling),
        .arrived(1'b0), .arrived_bank({IN_BITS{1'b0}}), .entered(enters), .left(leaves), .sent(sends),
        .acknowledged(acknowledged), .credit_window(credit_window), .next_row_in(next_row_in),
        .rows_entered(rows_entered), .rows_left(rows_left), .rows_sent(rows_sent), .next_entry(next_entry),
        .waiting(waiting), .played(played));

    reg settling_before = 1'b0;              // without the acknowledgement of this clock
    reg [31:0] number_before;                // stands until the next drop
    always @(posedge clk) begin
        settling_before <= settling;
        number_before <= drop_next_row;
    end
    always @(posedge clk) begin
        assume (DROPS || !drop);
        assume (!running || !acknowledge || !settling_before); // every packet is longer
        assume (!running || drop || drop_next_row == number_before);
        since_entry <= clear || enters ? 6'd0 : since_entry + (since_entry != 6'd63);
        since_drop <= clear ? 6'd0 : since_drop + (since_drop != 6'd63);
        since_change <= clear || enters || acknowledge ? 6'd0 : since_change + (since_change != 6'd63);
        if (clear) begin
            first <= running ? drop_next_row : 32'd0;
            entered <= running ? drop_next_row : 32'd0;
            left <= running ? drop_next_row : 32'd0;
            sent <= running ? drop_next_row : 32'd0;
        end else begin
            entered <= entered + enters;
            left <= left + leaves;
            sent <= sent + sends;
        end
    end

    wire [32:0] banks_end = {1'b0, entered} + BANKS;
    wire [31:0] window_right = banks_end[32] ? MOST : banks_end[31:0];
    always @(posedge clk)
        if (running) begin
            if (since_drop >= SOON)
                promises_no_more: assert (credit_window <= window_right && credit_window >= first);
            if (since_drop >= SETTLED) begin
                entered_counted: assert (acknowledged + rows_entered == entered);
                left_counted: assert (acknowledged + rows_left == left);
                sent_counted: assert (acknowledged + rows_sent == sent);
                never_beyond_sent: assert (acknowledged <= sent && acknowledged >= first);
                next_right: assert (next_entry == entered[ENTRY_BITS-1:0]);
            end
            if (since_change >= SOON)
                promises_all: assert (credit_window == window_right);
        end
endmodule

`default_nettype wire
