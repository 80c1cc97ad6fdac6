// Collects the rows that leave the core, and measures them: all times come from one free counter of pixel clocks that
// is read when a sample passes the core's pins.
`default_nettype none

module halfrow_collector #(
    parameter OUT_BITS = 1,
    parameter COLUMN_BITS = 11
) (
    input  wire                   clk,
    input  wire                   rst,           // also while rows are dropped

    input  wire                   burst,         // rows are a burst's: they are measured, and belong into no bank
    input  wire                   start,         // pulse: a row starts, its first sample is at the pins a clock later
    input  wire [OUT_BITS-1:0]    start_bank,
    input  wire                   start_tables,  // bank of the tables that it is bound to
    input  wire                   active_bank,

    // the core's pins
    input  wire                   enable,
    input  wire                   in_valid,
    input  wire                   in_start,
    input  wire                   in_last,
    input  wire [15:0]            pauses,        // with in_last
    input  wire                   out_valid,
    input  wire                   out_start,
    input  wire                   out_last,

    input  wire [OUT_BITS-1:0]    leaving_bank,  // of the oldest row that has not left
    output wire                   sample_write,  // the sample at the pins belongs into `column` of that bank
    output wire [COLUMN_BITS-1:0] column,
    output wire                   leaves,        // pulse: and is the row's last

    output reg                    row_left,      // pulse; what follows stays until the next row has left
    output reg  [OUT_BITS-1:0]    left_bank,
    output reg  [15:0]            first_latency, // pixel clocks
    output reg  [15:0]            last_latency,
    output reg  [15:0]            left_pauses,

    output wire                   row_inside,    // a row is
    output wire                   other_tables   // a row inside is bound to the bank that is not active
);
    localparam ROW_BANKS_OUT = 1 << OUT_BITS;

    reg [ROW_BANKS_OUT-1:0] inside_banks;
    reg [ROW_BANKS_OUT-1:0] tables_of;

    always @(posedge clk)
        if (start)
            tables_of[start_bank] <= start_tables;

    always @(posedge clk)
        if (rst)
            inside_banks <= {ROW_BANKS_OUT{1'b0}};
        else begin
            if (start && !burst)
                inside_banks[start_bank] <= 1'b1;
            if (leaves)
                inside_banks[leaving_bank] <= 1'b0;
        end

    assign row_inside = inside_banks != {ROW_BANKS_OUT{1'b0}};
    assign other_tables = (inside_banks & (tables_of ^ {ROW_BANKS_OUT{active_bank}})) != {ROW_BANKS_OUT{1'b0}};

    // A row's first sample has left before the next one's enters, and so has its last, since W/2 + L <= W.
    reg [15:0] now, first_in, last_in, row_pauses, first;

    always @(posedge clk)
        if (rst)
            now <= 16'd0;
        else if (enable)
            now <= now + 16'd1;

    always @(posedge clk) begin
        if (enable && in_valid && in_start)
            first_in <= now;
        if (enable && in_valid && in_last) begin
            last_in <= now;
            row_pauses <= pauses;
        end
    end

    reg [COLUMN_BITS-1:0] next_column;
    wire [15:0] latency = now - (out_last ? last_in : first_in);

    assign column = out_start ? {COLUMN_BITS{1'b0}} : next_column;
    wire collects = enable && out_valid && (burst || inside_banks[leaving_bank]);
    assign sample_write = collects && !burst;
    assign leaves = sample_write && out_last;

    always @(posedge clk) begin
        if (collects) begin
            next_column <= column + 1'b1;
            if (out_start)
                first <= latency;
            if (out_last) begin
                first_latency <= first;
                last_latency <= latency;
                left_pauses <= row_pauses;
                left_bank <= leaving_bank;
            end
        end
        row_left <= leaves && !rst;
    end
endmodule

`default_nettype wire
