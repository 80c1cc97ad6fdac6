// The board's number. An ECP5 has none that its logic can read, so the build gives it; 0 where the build was given none.
`default_nettype none
`include "halfrow_build.vh"

module board_serial (
    input  wire        link_clk,
    input  wire        link_rst,
    output wire [63:0] serial,
    output wire        ready
);
    wire unused = &{1'b0, link_clk, link_rst};

    assign serial = `HALFROW_SERIAL;
    assign ready = 1'b1;
endmodule

`default_nettype wire
