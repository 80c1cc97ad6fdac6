module ram_style_missing (
    input  wire       clk,
    input  wire [4:0] address,
    input  wire [7:0] data,
    output reg  [7:0] read
);
    reg [7:0] words [0:31];

    always @(posedge clk) begin
        words[address] <= data;
        read <= words[address];
    end
endmodule
