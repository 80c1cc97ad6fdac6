// Memory for samples: written at one place and read at another.
`default_nettype none

module halfrow_row_bank #(
    parameter ADDRESS_BITS = 12
) (
    input  wire                    clk,
    input  wire                    write,
    input  wire [ADDRESS_BITS-1:0] write_address,
    input  wire [11:0]             write_sample,
    input  wire                    read,
    input  wire [ADDRESS_BITS-1:0] read_address,
    output reg  [11:0]             read_sample // stays until the next read
);
    (* ram_style = "block" *) reg [11:0] samples [0:(1<<ADDRESS_BITS)-1];

    always @(posedge clk) begin
        if (write)
            samples[write_address] <= write_sample;
        if (read)
            read_sample <= samples[read_address];
    end
endmodule

`default_nettype wire
