// The core with rows of any walk of the source column that is legal for its ring, any gaps, any blanking, any reset: it reads from the
// ring what the row that leaves has written there and nothing else, and each output stands D = W/2 + L pixel clocks behind its
// sample. Samples and products play no part.
`default_nettype none

module core_rows #(
    parameter W = 12,                        // columns
    parameter RING_BITS = 4,
    parameter TAPS = 7,
    parameter GAPS = 0                       // 1: clocks without enable
) (
    input wire clk,
    input wire wants_gap,
    input wire wants_row,
    input wire junk,
    input wire [36:0] s                      // the source coordinate
);
    localparam D = W / 2 + (TAPS == 7 ? 12 : 11);
    localparam BEGUN = W / 2 + 1;            // pixel clocks from a sample to its column's source coordinate
    localparam READ = BEGUN + 3;             // and to the read that its taps need
    localparam M = 1 << RING_BITS;

    reg running = 1'b0;
    always @(posedge clk) running <= 1'b1;
    wire rst = !running;
    wire enable = !(GAPS && wants_gap);

    // The source of samples. Rows take turns between two first columns, which stand at the port until the row begins to leave.
    reg  [11:0] column = 12'd0;
    (* anyconst *) wire [11:0] first_0, first_1;
    reg         row = 1'b0;
    wire [11:0] first = column > W / 2 ? {12{junk}} : row ? first_1 : first_0;
    wire        in_valid = column != 12'd0 || wants_row;
    wire        in_start = column == 12'd0 && wants_row;
    wire        in_last = column == W - 1;

    always @(posedge clk)
        if (rst) begin
            column <= 12'd0;
            row <= 1'b0;
        end else if (enable && in_valid) begin
            column <= in_last ? 12'd0 : column + 12'd1;
            row <= row ^ in_last;
        end

    wire        out_valid, out_start, out_last, row_short, row_long, ring_write, ring_read;
    wire [RING_BITS-1:0] write_address, read_address;
    halfrow_core core (
        .clk(clk), .rst(rst), .enable(enable), .width(W[11:0]), .table_entry({first, 25'd0}), .table_data(80'd0),
        .in_valid(in_valid), .in_start(in_start), .in_sample(12'd0),
        .out_valid(out_valid), .out_start(out_start), .out_last(out_last), .row_short(row_short), .row_long(row_long),
        .ring_write(ring_write), .write_address(write_address), .ring_read(ring_read), .read_address(read_address),
        .\source.line.sum (s));

    // Bit k: the sample that was taken k + 1 pixel clocks ago.
    reg [D-1:0] valids = {D{1'b0}}, starts = {D{1'b0}}, lasts = {D{1'b0}};
    always @(posedge clk)
        if (rst)
            {valids, starts, lasts} <= {3*D{1'b0}};
        else if (enable) begin
            valids <= {valids[D-2:0], in_valid};
            starts <= {starts[D-2:0], in_start};
            lasts <= {lasts[D-2:0], in_valid && in_last};
        end

    reg  [11:0] n_1, n_2, n_3, n_4;
    // The column that the source coordinate is of. From one to the next its column moves by none or one, in any order.
    wire        begun = valids[BEGUN-1];
    wire        begins = starts[BEGUN-1];
    reg  [11:0] begun_column = 12'd0;
    reg         begun_row = 1'b0;
    wire [11:0] n = s[36:25];

    always @(posedge clk)
        if (rst) begin
            begun_column <= 12'd0;
            begun_row <= 1'b0;
        end else if (enable && begun) begin
            begun_column <= lasts[BEGUN-1] ? 12'd0 : begun_column + 12'd1;
            begun_row <= begun_row ^ lasts[BEGUN-1];
        end

    // The two conditions of DATAPATH.md's section "Ring"; and that a row reads beyond its last column late only (README.md).
    always @(posedge clk)
        if (running && begun) begin
            assume (n < W && (begins ? n == (begun_row ? first_1 : first_0) : n == n_1 || n == n_1 + 12'd1));
            assume (!begins || n + 12'd4 <= W / 2 + 3);
            assume (begun_column + W / 2 - 1 < M + n);
            assume (n + 12'd4 < W || begun_column >= W / 2 - 2);
        end

    // The newest column that the taps need, three pixel clocks later, and where the row's first sample lies.
    wire        reads = valids[READ-1];
    wire [11:0] m = n_3 + 12'd4;
    wire [11:0] newest = m >= W ? W - 12'd2 + {11'd0, m[0]} : m;
    reg  [RING_BITS-1:0] entering_base, leaving_base;
    reg  [RING_BITS+1:0] entering_age, leaving_age;              // samples since it

    always @(posedge clk)
        if (enable) begin
            {n_1, n_2, n_3, n_4} <= {n, n_1, n_2, n_3};
            if (in_start)
                entering_base <= write_address;
            if (in_valid) begin
                entering_age <= in_start ? 1 : entering_age + 1'b1;
                leaving_age <= leaving_age + 1'b1;
            end
            if (starts[READ-2]) begin
                leaving_base <= entering_base;
                leaving_age <= entering_age + in_valid;
            end
        end

    always @(posedge clk)
        if (running && !rst) begin
            writes_each_sample_once: assert (ring_write == (enable && in_valid));
            reads_on_pixel_clocks: assert (enable || !ring_read);
            if (reads && enable) begin
                if (ring_read) begin
                    own_sample: assert (read_address == leaving_base + newest[RING_BITS-1:0]);
                    there: assert (leaving_age > newest && leaving_age - newest <= M);
                end
                reads_each_column: assert (ring_read || (!starts[READ-1] && n_3 == n_4));
            end
            out_in_time: assert (out_valid == valids[D-1]);
            out_marked: assert (!out_valid || (out_start == starts[D-1] && out_last == lasts[D-1]));
            not_flagged: assert (!row_short && !row_long);
        end
endmodule

`default_nettype wire
