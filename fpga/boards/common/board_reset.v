// A reset that begins at once, even without a clock, and ends in step with the clock.
`default_nettype none

module board_reset (
    input  wire clk,
    input  wire hold,                   // any clock
    output wire rst
);
    (* ASYNC_REG = "TRUE" *) reg [3:0] held = 4'hf;

    always @(posedge clk or posedge hold)
        if (hold)
            held <= 4'hf;
        else
            held <= {held[2:0], 1'b0};

    assign rst = held[3];
endmodule

`default_nettype wire
