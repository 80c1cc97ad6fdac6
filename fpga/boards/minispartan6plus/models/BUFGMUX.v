// What the board's bench and lint need of the vendor's cell: the asynchronous kind, which is a multiplexer and nothing else.
`default_nettype none

module BUFGMUX #(
    parameter CLK_SEL_TYPE = "ASYNC"
) (
    input  wire I0,
    input  wire I1,
    input  wire S,
    output wire O
);
    assign O = S ? I1 : I0;
endmodule

`default_nettype wire
