// What the board's bench and lint need of the vendor's cell.
`default_nettype none

module IBUFG (
    input  wire I,
    output wire O
);
    assign O = I;
endmodule

`default_nettype wire
