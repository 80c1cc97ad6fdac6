// addend + (minuend - subtrahend) * factor, in three stages, as one DSP slice does it. The factor comes one enabled
// clock behind the minuend, the addend two. The sum has the slice's 48 bits: narrower ones are not mapped soundly by
// every tool, and neither is the sum of the signed product: of five taps yosys 0.23 then leaves no DSP slice.
`default_nettype none

module halfrow_multiply_add #(
    parameter BITS = 16,
    parameter DIFFERENCE_BITS = 17 // no more than it needs: a tool gives the pre-adder to the narrower operand
) (
    input  wire                   clk,
    input  wire                   enable,
    input  wire signed [BITS-1:0] minuend,
    input  wire signed [BITS-1:0] subtrahend,
    input  wire signed [15:0]     factor,
    input  wire signed [47:0]     addend,
    output reg  signed [47:0]     sum
);
    reg signed [DIFFERENCE_BITS-1:0] difference;
    reg signed [DIFFERENCE_BITS+15:0] product;

    always @(posedge clk)
        if (enable) begin
            difference <= minuend - subtrahend;
            product <= factor * difference;
            sum <= addend + {{32-DIFFERENCE_BITS{product[DIFFERENCE_BITS+15]}}, product};
        end
endmodule

`default_nettype wire
