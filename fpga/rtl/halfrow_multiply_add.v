// addend + (minuend - subtrahend) * factor, in three stages, as one DSP slice does it. The factor comes one enabled clock
// behind the minuend, the addend two. The sum has the slice's 48 bits: narrower ones are not mapped soundly by every tool.
`default_nettype none

module halfrow_multiply_add (
    input  wire               clk,
    input  wire               enable,
    input  wire signed [16:0] minuend,
    input  wire signed [16:0] subtrahend,
    input  wire signed [16:0] factor,
    input  wire signed [47:0] addend,
    output reg  signed [47:0] sum
);
    reg signed [17:0] difference;
    reg signed [34:0] product;

    always @(posedge clk)
        if (enable) begin
            difference <= minuend - subtrahend;
            product <= difference * factor;
            sum <= addend + {{13{product[34]}}, product};
        end
endmodule

`default_nettype wire
