// What lint and the board's benches need of the vendor's cell.
`default_nettype none

module DCCA (
    input  wire CLKI,
    input  wire CE,
    output wire CLKO
);
    assign CLKO = CLKI && CE;
endmodule

`default_nettype wire
