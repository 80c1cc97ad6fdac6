// Whether two words are equal, one clock later. The register in the middle is for the mapper, which would trade
// look-up tables for depth.
`default_nettype none

module halfrow_equal #(
    parameter WIDTH = 32
) (
    input  wire             clk,
    input  wire [WIDTH-1:0] a,
    input  wire [WIDTH-1:0] b,
    output wire             equal
);
    localparam PARTS = (WIDTH + 2) / 3;

    wire [3*PARTS-1:0] same = {{3 * PARTS - WIDTH{1'b1}}, ~(a ^ b)};
    reg [PARTS-1:0] parts_same;
    integer i;

    always @(posedge clk) for (i = 0; i < PARTS; i = i + 1) parts_same[i] <= &same[3*i +: 3];

    assign equal = &parts_same;
endmodule

`default_nettype wire
