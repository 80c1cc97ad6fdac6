// One byte's step of the CRC-32 of WIRE.md section 1. Preset and final inversion are the user's.
`default_nettype none

module halfrow_crc32 (
    input  wire [31:0] crc,
    input  wire [7:0]  data,
    output wire [31:0] next
);
    function [31:0] step(input [31:0] state);
        integer i;
        begin
            step = state;
            for (i = 0; i < 8; i = i + 1) step = {1'b0, step[31:1]} ^ (step[0] ? 32'hEDB88320 : 32'd0);
        end
    endfunction

    assign next = step(crc ^ {24'd0, data});
endmodule

`default_nettype wire
