// A level on its way into another clock.
`default_nettype none

module board_bit (
    input  wire clk,
    input  wire level,                  // any clock
    output wire seen
);
    (* ASYNC_REG = "TRUE", SHREG_EXTRACT = "NO" *) reg [1:0] caught = 2'b00;

    always @(posedge clk)
        caught <= {caught[0], level};

    assign seen = caught[1];
endmodule

`default_nettype wire
