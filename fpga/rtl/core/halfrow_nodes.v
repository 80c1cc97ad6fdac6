// A copy of the kernel's nodes with one port to read: node 0 to 64 of either bank. A tool may take the second register
// behind the memory from the block RAM itself.
`default_nettype none

module halfrow_nodes #(
    parameter WIDTH = 80,
    parameter TABLE_BANKS = 2
) (
    input  wire             clk,
    input  wire             write,
    input  wire [7:0]       write_address, // {bank, node}
    input  wire [WIDTH-1:0] write_node,
    input  wire             read,
    input  wire [7:0]       read_address,
    output reg  [WIDTH-1:0] read_node // two clocks with `read` behind its address
);
    localparam BITS = (TABLE_BANKS == 2) ? 8 : 7;

    wire unused = &{1'b0, write_address[7], read_address[7]}; // with one bank

    (* ram_style = "block", no_rw_check *) reg [WIDTH-1:0] nodes [0:(1 << BITS)-1];
    reg [WIDTH-1:0] from_memory;

    always @(posedge clk) begin
        if (write)
            nodes[write_address[BITS-1:0]] <= write_node;
        if (read) begin
            from_memory <= nodes[read_address[BITS-1:0]];
            read_node <= from_memory;
        end
    end
endmodule

`default_nettype wire
