// fpga/rtl's halfrow_multiply_add with sums of 34 bits, as many as they need. Right as it stands, but yosys 0.23 maps them
// unsoundly to a DSP slice's post-adder, which the check of the netlist must see.
`default_nettype none

module halfrow_multiply_add #(
    parameter BITS = 16,
    parameter DIFFERENCE_BITS = 17
) (
    input  wire                   clk,
    input  wire                   enable,
    input  wire signed [BITS-1:0] minuend,
    input  wire signed [BITS-1:0] subtrahend,
    input  wire signed [15:0]     factor,
    input  wire signed [47:0]     addend,
    output wire signed [47:0]     sum
);
    reg signed [DIFFERENCE_BITS-1:0] difference;
    reg signed [DIFFERENCE_BITS+15:0] product;
    reg signed [33:0] narrow_sum;
    wire signed [33:0] narrow_addend = addend[33:0];

    always @(posedge clk)
        if (enable) begin
            difference <= minuend - subtrahend;
            product <= factor * difference;
            narrow_sum <= narrow_addend + product;
        end
    assign sum = {{14{narrow_sum[33]}}, narrow_sum};
endmodule

`default_nettype wire
