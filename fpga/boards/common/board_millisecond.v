// One pulse each millisecond, in the link's clock and in the core's; counted in the link's, which never stops.
`default_nettype none

module board_millisecond #(
    parameter [16:0] LINK_KHZ = 17'd96000 // clocks of link_clk in a millisecond, 2 to 2^17
) (
    input  wire link_clk,
    output reg  link_millisecond,
    input  wire clk,
    output wire millisecond
);
    reg [16:0] count = 17'd0;
    reg        turn = 1'b0;
    wire       last = count == LINK_KHZ - 17'd1;

    always @(posedge link_clk) begin
        count <= last ? 17'd0 : count + 17'd1;
        turn <= turn ^ last;
        link_millisecond <= last;
    end

    wire now;
    reg  turn_before = 1'b0;

    board_bit turn_bit (.clk(clk), .level(turn), .seen(now));

    always @(posedge clk)
        turn_before <= now;

    assign millisecond = now != turn_before;
endmodule

`default_nettype wire
