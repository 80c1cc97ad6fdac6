// Makes a pulse long enough to be seen: a quarter of a second.
`default_nettype none

module board_lamp (
    input  wire clk,
    input  wire rst,
    input  wire millisecond,
    input  wire pulse,
    output wire lamp
);
    reg [7:0] left;

    always @(posedge clk)
        if (rst)
            left <= 8'd0;
        else if (pulse)
            left <= 8'd255;
        else if (millisecond && lamp)
            left <= left - 8'd1;

    assign lamp = left != 8'd0;
endmodule

`default_nettype wire
