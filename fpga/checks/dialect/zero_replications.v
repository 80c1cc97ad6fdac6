module zero_replications #(
    parameter TAPS = 7
) (
    input  wire [12*TAPS-1:0] chosen,
    output wire [83:0]        taps
);
    localparam FIRST = (TAPS == 7) ? 0 : 1;

    assign taps = {{12*FIRST{1'b0}}, chosen, {12*FIRST{1'b0}}};
endmodule
