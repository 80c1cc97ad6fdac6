// The kernel's nodes, read two at a time, and the weights between them: w[i] + (((w[i+1] - w[i]) * t + 2^7) >> 8).
// The weights come five enabled clocks behind node and fraction.
`default_nettype none

module halfrow_kernel #(
    parameter TAPS = 7,
    parameter TABLE_BANKS = 2
) (
    input  wire        clk,
    input  wire        enable,
    input  wire        bank,
    input  wire [5:0]  node,
    input  wire [7:0]  fraction,
    output wire [79:0] weights, // {g6, r5, g4, r1, g0}, 14 fractional bits each

    input  wire        node_write,
    input  wire        table_read,
    input  wire        table_bank,
    input  wire [6:0]  table_entry,
    input  wire [79:0] table_data,
    output wire [79:0] node_port_0,
    output wire [79:0] node_port_1
);
    localparam FIRST = (TAPS == 7) ? 0 : 1; // the first weight that is stored
    localparam STORED = TAPS - 2;

    wire unused = &{1'b0, table_data}; // without outer taps g0 and g6 are not stored

    wire read = enable || table_read;
    wire [7:0] left = {bank, 1'b0, node};
    wire [7:0] address_0 = table_read ? {table_bank, table_entry} : left;
    wire [7:0] address_1 = table_read ? {table_bank, table_entry} : left + 8'd1;

    wire [16*STORED-1:0] node_0, node_1;
    wire [16*STORED-1:0] written = table_data[16*FIRST +: 16*STORED];

    halfrow_nodes #(.WIDTH(16 * STORED), .TABLE_BANKS(TABLE_BANKS)) nodes_0 (
        .clk(clk), .write(node_write), .write_address({table_bank, table_entry}), .write_node(written),
        .read(read), .read_address(address_0), .read_node(node_0));
    halfrow_nodes #(.WIDTH(16 * STORED), .TABLE_BANKS(TABLE_BANKS)) nodes_1 (
        .clk(clk), .write(node_write), .write_address({table_bank, table_entry}), .write_node(written),
        .read(read), .read_address(address_1), .read_node(node_1));

    generate
        if (TAPS == 7) begin : outer
            assign node_port_0 = node_0;
            assign node_port_1 = node_1;
        end else begin : inner
            assign node_port_0 = {16'd0, node_0, 16'd0};
            assign node_port_1 = {16'd0, node_1, 16'd0};
        end
    endgenerate

    reg [23:0] fractions;
    always @(posedge clk)
        if (enable)
            fractions <= {fractions[15:0], fraction};

    genvar k;
    generate
        for (k = 0; k < 5; k = k + 1) begin : weight
            if (k >= FIRST && k < FIRST + STORED) begin : stored
                wire signed [15:0] from = node_port_0[16*k +: 16];
                wire signed [15:0] to = node_port_1[16*k +: 16];
                reg signed [15:0] from_1, from_2;
                wire signed [47:0] sum;

                always @(posedge clk)
                    if (enable) begin
                        from_1 <= from;
                        from_2 <= from_1;
                    end

                halfrow_multiply_add interpolate (
                    .clk(clk), .enable(enable), .minuend(to), .subtrahend(from),
                    .factor({8'd0, fractions[23:16]}), .addend({{24{from_2[15]}}, from_2, 8'd128}), .sum(sum));
                assign weights[16*k +: 16] = sum[23:8];
                wire unused_sum = &{1'b0, sum[47:24], sum[7:0]};
            end else begin : absent
                assign weights[16*k +: 16] = 16'd0;
            end
        end
    endgenerate
endmodule

`default_nettype wire
