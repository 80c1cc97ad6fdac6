// A clock out of a pin.
`default_nettype none

module board_clock_out (
    input  wire clk,
    output wire pin
);
    ODDRX1F register (.Q(pin), .SCLK(clk), .RST(1'b0), .D0(1'b1), .D1(1'b0));
endmodule

`default_nettype wire
