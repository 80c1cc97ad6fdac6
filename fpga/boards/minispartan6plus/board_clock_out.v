// A clock out of a pin, in step with the registers at the pins beside it.
`default_nettype none

module board_clock_out (
    input  wire clk,
    output wire pin
);
    ODDR2 register (.Q(pin), .C0(clk), .C1(!clk), .CE(1'b1), .D0(1'b1), .D1(1'b0), .R(1'b0), .S(1'b0));
endmodule

`default_nettype wire
