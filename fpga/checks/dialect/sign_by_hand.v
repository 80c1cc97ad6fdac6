module sign_by_hand (
    input  wire               clk,
    input  wire signed [47:0] addend,
    input  wire signed [32:0] product,
    output reg  signed [47:0] sum
);
    always @(posedge clk)
        sum <= addend + {{15{product[32]}}, product};
endmodule
