// What the board's bench and lint need of the vendor's cell: READ loads the number, SHIFT moves it, the highest bit first.
`default_nettype none

module DNA_PORT #(
    parameter [56:0] SIM_DNA_VALUE = 57'h123456789abcdef
) (
    input  wire CLK,
    input  wire DIN,
    input  wire READ,
    input  wire SHIFT,
    output wire DOUT
);
    reg [56:0] number;

    always @(posedge CLK)
        if (READ)
            number <= SIM_DNA_VALUE;
        else if (SHIFT)
            number <= {number[55:0], DIN};

    assign DOUT = number[56];
endmodule

`default_nettype wire
