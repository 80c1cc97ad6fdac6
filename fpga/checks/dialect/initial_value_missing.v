module initial_value_missing (
    input  wire clk,
    input  wire write,
    output reg  strobe_n
);
    always @(posedge clk)
        strobe_n <= !write;
endmodule
