module memory_of_many_writers (
    input  wire        clk,
    input  wire [7:0]  data,
    output wire [31:0] last
);
    (* ram_style = "distributed" *) reg [7:0] slots [0:3];
    genvar k;
    generate
        for (k = 0; k < 4; k = k + 1) begin : slot
            if (k == 3) begin : newest
                always @(posedge clk)
                    slots[k] <= data;
            end else begin : older
                always @(posedge clk)
                    slots[k] <= slots[k+1];
            end
            assign last[8*k +: 8] = slots[k];
        end
    endgenerate
endmodule
