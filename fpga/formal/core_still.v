// The core on a clock without enable: what is left of it after constants have been put through is all that can still move.
`default_nettype none

module core_still (
    input  wire        clk,
    input  wire        in_valid,
    input  wire        in_start,
    input  wire [11:0] in_sample,
    input  wire [11:0] width,
    input  wire [1:0]  depth,
    input  wire [36:0] table_entry,
    input  wire [79:0] table_data,
    output wire        out_valid,
    output wire        out_start,
    output wire        out_last,
    output wire [11:0] out_sample
);
    halfrow_core core (
        .clk(clk), .rst(1'b0), .enable(1'b0), .width(width), .depth(depth), .table_read(1'b0), .node_write(1'b0),
        .table_bank(1'b0), .table_entry(table_entry), .table_data(table_data),
        .in_valid(in_valid), .in_start(in_start), .in_sample(in_sample),
        .out_valid(out_valid), .out_start(out_start), .out_last(out_last), .out_sample(out_sample));
endmodule

`default_nettype wire
